#include "diagnosis/focus.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

#include "base/dense.hpp"
#include "base/parallel.hpp"
#include "diagnosis/no_solution.hpp"
#include "solver/reduced_model.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr int kDoubts = 40, kChecks = 4;
constexpr int kClaims = 6;           // number of claims at once
constexpr int kSmallEnough = 24;     // states; with fewer nothing is gained
constexpr double kLeftOut_K = 1e-3;  // root mean square of the part outside the basis; 2 um/K
constexpr int kThin = 4;             // every so many rows are used

/// A machine with small errors in everything and large ones in some places. The same seed gives the same state.
TwinState doubt(const Twin& twin, const std::vector<Knob>& scatter, const std::vector<Candidate>& candidates,
                unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<double>(random()) / static_cast<double>(std::mt19937::max()); };
  TwinState state = twin.as_written();
  for (const Knob& k : scatter) k.set(state, k.value(k.prior_sd * 3.0 * (uniform() - 0.5)));
  std::vector<const Variant*> variants;
  for (const Candidate& c : candidates) {
    for (const Variant& v : c.variants) {
      const bool moves_machine = std::any_of(v.knobs.begin(), v.knobs.end(), [](const Knob& k) { return !k.reading_only; });
      if (moves_machine) variants.push_back(&v);
    }
  }
  for (int i = 0; i < kClaims && !variants.empty(); ++i) {
    const Variant& v =
        *variants[std::min(variants.size() - 1, static_cast<std::size_t>(uniform() * static_cast<double>(variants.size())))];
    const std::vector<double>& shape =
        v.grid[std::min(v.grid.size() - 1, static_cast<std::size_t>(uniform() * static_cast<double>(v.grid.size())))];
    v.knobs[0].set(state, v.knobs[0].value(v.trial_x * 6.0 * (uniform() - 0.35)));
    for (std::size_t k = 0; k < shape.size(); ++k) v.knobs[k + 1].set(state, v.knobs[k + 1].value(shape[k]));
  }
  return state;
}

}  // namespace

Focus focus(const Twin& twin, const std::vector<MeasuredRun>& runs, const std::vector<Knob>& scatter,
            const std::vector<Candidate>& candidates) {
  const solver::ReducedSystem& system = twin.machine().system;
  Focus focus{twin.machine(), 0.0, 0.0};
  if (system.size() <= kSmallEnough) return focus;

  // Weights: 1 K everywhere, 1 K at a sensor and half a micrometre count the same.
  const auto n = static_cast<Eigen::Index>(system.size());
  Eigen::MatrixXd norm = Eigen::MatrixXd::Identity(n, n) / system.ones.squaredNorm();
  for (std::size_t o = 0; o < twin.outputs().unit.size(); ++o) {
    const double scale = twin.outputs().unit[o] == "K" ? 1.0 : twin.outputs().unit[o] == "m" ? 5e5 : 5e4;
    const Eigen::VectorXd w = scale * twin.outputs().state.col(static_cast<Eigen::Index>(o));
    norm += w * w.transpose();
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(norm);

  std::vector<Eigen::MatrixXd> squares(kDoubts);  // summed in order: the result does not depend on the number of threads
  std::vector<double> counts(kDoubts, 0.0);
  for_each_index(
      kDoubts, [&] { return Twin::Workspace(twin); },
      [&](std::size_t i, Twin::Workspace& workspace) {
        const TwinState state = i == 0 ? twin.as_written() : doubt(twin, scatter, candidates, static_cast<unsigned>(i));
        squares[i] = Eigen::MatrixXd::Zero(n, n);
        for (const MeasuredRun& run : runs) {
          Eigen::MatrixXd z;
          if (!has_solution([&] { z = twin.states(state, run, workspace); })) continue;  // too wrong to have a solution
          const Eigen::Index n_kept = (z.cols() + kThin - 1) / kThin;
          Eigen::MatrixXd y(n, n_kept);
          for (Eigen::Index c = 0; c < n_kept; ++c) y.col(c) = z.col(kThin * c);
          y = (factor.matrixU() * y).eval();
          squares[i].noalias() += y * y.transpose();
          counts[i] += static_cast<double>(n_kept);
        }
      });
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  double n_snapshots = 0.0;
  for (int i = 0; i < kDoubts; ++i) {
    sum += squares[static_cast<std::size_t>(i)];
    n_snapshots += counts[static_cast<std::size_t>(i)];
  }
  const dense::SymmetricEigen eigen(sum / std::max(1.0, n_snapshots));
  double left_out = 0.0;
  Eigen::Index size = n;
  while (size > 1 && left_out + std::max(0.0, eigen.eigenvalues()[n - size]) < kLeftOut_K * kLeftOut_K) {
    left_out += std::max(0.0, eigen.eigenvalues()[n - size]);
    --size;
  }
  Eigen::MatrixXd directions(n, size + 2);
  directions << twin.machine().start, system.ones, factor.matrixU().solve(eigen.eigenvectors().rightCols(size));
  const Eigen::MatrixXd basis = dense::PivotedQr(directions, 1e-9).basis();
  focus.machine.system = solver::project(system, basis);
  focus.machine.start = basis.transpose() * twin.machine().start;

  const Twin small(twin.augmented(), focus.machine, {});
  Twin::Workspace large_space(twin), small_space(small);
  double squares_K = 0.0, squares_m = 0.0, n_K = 0.0, n_m = 0.0;
  for (int i = 0; i < kChecks; ++i) {
    const TwinState state = i == 0 ? twin.as_written() : doubt(twin, scatter, candidates, 1000u + static_cast<unsigned>(i));
    for (const MeasuredRun& run : runs) {
      Eigen::MatrixXd miss;
      const bool is_solved =
          has_solution([&] { miss = small.respond(state, run, small_space) - twin.respond(state, run, large_space); });
      if (!is_solved) continue;
      for (const MeasuredChannel& c : run.channels) {
        const double square = miss.row(c.output).squaredNorm();
        (c.unit == "K" ? squares_K : squares_m) += c.unit == "rad" ? 0.01 * square : square;
        (c.unit == "K" ? n_K : n_m) += static_cast<double>(miss.cols());
      }
    }
  }
  focus.error_K = std::sqrt(squares_K / std::max(1.0, n_K));
  focus.error_m = std::sqrt(squares_m / std::max(1.0, n_m));
  return focus;
}

}  // namespace driftwright::diagnosis
