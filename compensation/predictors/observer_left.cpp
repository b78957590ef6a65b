#include "compensation/predictors/observer_left.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/dense.hpp"
#include "base/parallel.hpp"

namespace driftwright::compensation {
namespace {

/// Orthonormal directions among the factors, those that readings and drifts tell most of first, n_factors x as many as count.
Eigen::MatrixXd directions(const std::vector<RunSensitivity>& runs, int most) {
  const auto n = static_cast<Eigen::Index>(runs.front().drift_um.size());
  Eigen::MatrixXd by_reading = Eigen::MatrixXd::Zero(n, n), by_drift = by_reading;
  for (const RunSensitivity& run : runs) {
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        by_reading(i, j) += (run.reading_K[a].array() * run.reading_K[b].array()).sum() / run.reading_K2;
        by_drift(i, j) += (run.drift_um[a].array() * run.drift_um[b].array()).sum();
      }
    }
  }
  const double readings = by_reading.trace(), drifts = by_drift.trace();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  if (readings > 0.0) sum += by_reading / readings;
  if (drifts > 0.0) sum += by_drift / drifts;
  const dense::SymmetricEigen eigen(sum);
  Eigen::Index kept = 1;
  double rest = eigen.eigenvalues().head(n - 1).sum();
  while (kept < std::min<Eigen::Index>(n, most) && rest > ObserverLeft::kNeglected) rest -= eigen.eigenvalues()(n - 1 - kept++);
  return eigen.eigenvectors().rightCols(kept);
}

}  // namespace

ObserverLeft::ObserverLeft(const std::vector<RunSensitivity>& runs, std::vector<double> scatter) : scatter_(std::move(scatter)) {
  if (runs.empty() || scatter_.empty()) throw std::logic_error("ObserverLeft: no run, or no scatter");
  n_candidates_ = static_cast<int>(runs.front().reading_K.front().rows());
  n_drifts_ = runs.front().drift_um.front().rows();
  const Eigen::MatrixXd basis = directions(runs, kMost);
  n_directions_ = basis.cols();
  const Eigen::Index n = n_directions_, n_factors = basis.rows();
  for (const RunSensitivity& run : runs) {
    const Eigen::Index n_rows = run.drift_um.front().cols();
    Eigen::MatrixXd told = Eigen::MatrixXd::Zero(n * n, n_candidates_), j(n_factors, n_candidates_);
    Eigen::Index row = 0;
    for (int moment = 1; moment <= kMoments; ++moment) {
      const Eigen::Index end = moment == kMoments ? n_rows : n_rows * moment / kMoments;
      if (end == row) continue;
      for (; row < end; ++row) {
        for (Eigen::Index f = 0; f < n_factors; ++f) j.row(f) = run.reading_K[static_cast<std::size_t>(f)].col(row).transpose();
        const Eigen::MatrixXd seen = basis.transpose() * j / std::sqrt(run.reading_K2);
        for (Eigen::Index c = 0; c < n_candidates_; ++c) {
          Eigen::Map<Eigen::MatrixXd>(told.col(c).data(), n, n).noalias() += seen.col(c) * seen.col(c).transpose();
        }
      }
      Eigen::MatrixXd drift(n_factors, n_drifts_);
      for (Eigen::Index f = 0; f < n_factors; ++f) drift.row(f) = run.drift_um[static_cast<std::size_t>(f)].col(end - 1).transpose();
      moments_.push_back({told, basis.transpose() * drift});
    }
  }
}

ObserverLeft::Information ObserverLeft::information(const Moment& moment, std::span<const int> set, double scatter) const {
  Information sum = Information::Identity(n_directions_, n_directions_) / (scatter * scatter);
  for (int c : set) sum += Eigen::Map<const Eigen::MatrixXd>(moment.told.col(c).data(), n_directions_, n_directions_);
  return sum;
}

double ObserverLeft::variance(const Information& information, const Eigen::MatrixXd& drift) {
  const Eigen::LLT<Information> factor(information);
  double sum = 0.0;
  Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMost, 1> x;
  for (Eigen::Index d = 0; d < drift.cols(); ++d) {
    x = drift.col(d);
    factor.matrixL().solveInPlace(x);
    sum += x.squaredNorm();
  }
  return sum;
}

double ObserverLeft::of(std::span<const int> set) const {
  double sum = 0.0;
  for (const Moment& moment : moments_) {
    for (double scatter : scatter_) sum += variance(information(moment, set, scatter), moment.drift);
  }
  return std::sqrt(sum / static_cast<double>(moments_.size() * scatter_.size() * static_cast<std::size_t>(n_drifts_)));
}

std::vector<double> ObserverLeft::with_each(std::span<const int> set) const {
  std::vector<Information> known;
  for (const Moment& moment : moments_) {
    for (double scatter : scatter_) known.push_back(information(moment, set, scatter));
  }
  std::vector<double> left(static_cast<std::size_t>(n_candidates_));
  const auto n = static_cast<double>(known.size() * static_cast<std::size_t>(n_drifts_));
  parallel_for(left.size(), [&](std::size_t c) {
    double sum = 0.0;
    std::size_t at = 0;
    for (const Moment& moment : moments_) {
      const Eigen::Map<const Eigen::MatrixXd> told(moment.told.col(static_cast<Eigen::Index>(c)).data(), n_directions_, n_directions_);
      for (std::size_t s = 0; s < scatter_.size(); ++s) sum += variance(known[at++] + told, moment.drift);
    }
    left[c] = std::sqrt(sum / n);
  });
  return left;
}

}  // namespace driftwright::compensation
