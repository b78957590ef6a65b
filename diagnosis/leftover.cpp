#include "diagnosis/leftover.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace driftwright::diagnosis {
namespace {

constexpr Eigen::Index kFewest = 4;  // least readings of a channel in a record that could show a smooth rest

}  // namespace

double Leftover::sigmas() const {
  return (squares - n_curves) / std::sqrt(2.0 * std::max(1.0, n_curves));
}

std::vector<Leftover> leftovers(const std::vector<MeasuredRun>& runs, const Prediction& prediction,
                                const std::map<std::string, NoiseModel>& noise) {
  std::vector<Leftover> list;
  const Comparison comparison(runs, noise);
  const Eigen::VectorXd residual = comparison.measured() - comparison.whitened(prediction);
  std::vector<double> n_rows;
  for (std::size_t b = 0; b < comparison.blocks().size(); ++b) {
    const Comparison::Block& block = comparison.blocks()[b];
    if (block.n < kFewest) continue;
    const MeasuredRun& run = runs[block.run];
    const Eigen::MatrixXd curves = telling(curves_of(run), block.n);
    Eigen::MatrixXd x(block.n, curves.cols());
    for (Eigen::Index c = 0; c < curves.cols(); ++c) comparison.whitener(b).apply(curves.col(c), x.col(c));
    Eigen::MatrixXd normal = x.transpose() * x;
    normal.diagonal().array() += 1e-9 * normal.trace() / static_cast<double>(normal.rows());
    const Eigen::VectorXd r = residual.segment(block.first, block.n);
    const Eigen::VectorXd xr = x.transpose() * r, amplitude = normal.llt().solve(xr);
    auto found = std::find_if(list.begin(), list.end(), [&](const Leftover& l) { return l.channel == block.channel; });
    if (found == list.end()) {
      list.push_back({.channel = block.channel, .unit = run.find(block.channel)->unit});
      n_rows.push_back(0.0);
      found = list.end() - 1;
    }
    found->squares += xr.dot(amplitude);
    found->n_curves += static_cast<double>(curves.cols());
    // Rows without readings are left out: there the curves could have any value.
    const std::vector<char> there = present(run.find(block.channel)->value);
    const Eigen::VectorXd smooth = curves * amplitude;
    for (Eigen::Index i = 0; i < smooth.size(); ++i) {
      if (there[static_cast<std::size_t>(i)]) found->rms += smooth[i] * smooth[i];
    }
    Eigen::VectorXd step(curves.rows()), whitened(block.n);
    for (Eigen::Index from = 2; from + 2 < curves.rows(); ++from) {
      step.setZero();
      step.tail(curves.rows() - from).setOnes();
      comparison.whitener(b).apply(step, whitened);
      const double square = whitened.squaredNorm();
      if (!(square > 1e-12)) continue;
      const double size = whitened.dot(r) / square;
      if (size * size * square <= found->jump_squares) continue;
      found->jump_squares = size * size * square;
      found->jump = std::abs(size);
    }
    n_rows[static_cast<std::size_t>(found - list.begin())] += static_cast<double>(block.n);
  }
  for (std::size_t i = 0; i < list.size(); ++i) list[i].rms = std::sqrt(list[i].rms / n_rows[i]);
  std::stable_sort(list.begin(), list.end(), [](const Leftover& a, const Leftover& b) { return a.sigmas() > b.sigmas(); });
  return list;
}

double sigmas(const std::vector<Leftover>& leftovers) {
  Leftover all;
  for (const Leftover& l : leftovers) {
    all.squares += l.squares;
    all.n_curves += l.n_curves;
  }
  return all.sigmas();
}

}  // namespace driftwright::diagnosis
