#include "compensation/predictors/observer_left.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "base/dense.hpp"

namespace driftwright::compensation {
namespace {

constexpr int kPack = 8;  // candidates that are computed in parallel
using Pack = Eigen::Array<double, kPack, 1>;

/// Σ_d j_d' A⁻¹ j_d of kPack matrices A at once, by Cholesky's decomposition.
/// @param entry  of the lower triangles, by rows
template <int kMost, class Entry>
Pack variances(const Entry& entry, const Eigen::MatrixXd& drift) {
  std::array<Pack, kMost*(kMost + 1) / 2> lower;
  std::array<Pack, kMost> inverse;  // of the diagonal
  const Eigen::Index n = drift.rows();
  const auto at = [](Eigen::Index i, Eigen::Index j) { return static_cast<std::size_t>(i * (i + 1) / 2 + j); };
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      Pack sum = entry(i * (i + 1) / 2 + j);
      for (Eigen::Index k = 0; k < j; ++k) sum -= lower[at(i, k)] * lower[at(j, k)];
      if (j < i) {
        lower[at(i, j)] = sum * inverse[static_cast<std::size_t>(j)];
      } else {
        inverse[static_cast<std::size_t>(i)] = sum.rsqrt();
      }
    }
  }
  Pack all = Pack::Zero();
  std::array<Pack, kMost> x;
  for (Eigen::Index d = 0; d < drift.cols(); ++d) {
    for (Eigen::Index i = 0; i < n; ++i) {
      Pack sum = Pack::Constant(drift(i, d));
      for (Eigen::Index k = 0; k < i; ++k) sum -= lower[at(i, k)] * x[static_cast<std::size_t>(k)];
      x[static_cast<std::size_t>(i)] = sum * inverse[static_cast<std::size_t>(i)];
      all += x[static_cast<std::size_t>(i)].square();
    }
  }
  return all;
}

/// Orthonormal directions among the factors, sorted by their effect on readings and drifts, n_factors x number of
/// significant ones.
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
  while (kept < std::min<Eigen::Index>(n, most) && rest > ObserverLeft::kNeglected)
    rest -= eigen.eigenvalues()(n - 1 - kept++);
  return eigen.eigenvectors().rightCols(kept);
}

}  // namespace

ObserverLeft::ObserverLeft(const std::vector<RunSensitivity>& runs, std::vector<double> scatter)
    : scatter_(std::move(scatter)) {
  if (runs.empty() || scatter_.empty()) throw std::logic_error("ObserverLeft: no run, or no scatter");
  n_candidates_ = static_cast<int>(runs.front().reading_K.front().rows());
  n_drifts_ = runs.front().drift_um.front().rows();
  const Eigen::MatrixXd basis = directions(runs, kMost);
  n_directions_ = basis.cols();
  const Eigen::Index n = n_directions_, n_factors = basis.rows();
  const Eigen::Index n_packed = (n_candidates_ + kPack - 1) / kPack * kPack;
  for (const RunSensitivity& run : runs) {
    const Eigen::Index n_rows = run.drift_um.front().cols();
    Eigen::MatrixXd told = Eigen::MatrixXd::Zero(n_packed, n * (n + 1) / 2), j(n_factors, n_candidates_);
    Eigen::Index row = 0;
    for (int moment = 1; moment <= kMoments; ++moment) {
      const Eigen::Index end = moment == kMoments ? n_rows : n_rows * moment / kMoments;
      if (end == row) continue;
      for (; row < end; ++row) {
        for (Eigen::Index f = 0; f < n_factors; ++f)
          j.row(f) = run.reading_K[static_cast<std::size_t>(f)].col(row).transpose();
        const Eigen::MatrixXd seen = (j.transpose() * basis) / std::sqrt(run.reading_K2);
        for (Eigen::Index a = 0, at = 0; a < n; ++a) {
          for (Eigen::Index b = 0; b <= a; ++b, ++at)
            told.col(at).head(n_candidates_).array() += seen.col(a).array() * seen.col(b).array();
        }
      }
      Eigen::MatrixXd drift(n_factors, n_drifts_);
      for (Eigen::Index f = 0; f < n_factors; ++f)
        drift.row(f) = run.drift_um[static_cast<std::size_t>(f)].col(end - 1).transpose();
      moments_.push_back({told, basis.transpose() * drift});
    }
  }
}

Eigen::VectorXd ObserverLeft::information(const Moment& moment, std::span<const int> set, double scatter) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(moment.told.cols());
  for (Eigen::Index i = 0; i < n_directions_; ++i) sum(i * (i + 3) / 2) = 1.0 / (scatter * scatter);
  for (int c : set) sum += moment.told.row(c).transpose();
  return sum;
}

double ObserverLeft::of(std::span<const int> set) const {
  double sum = 0.0;
  for (const Moment& moment : moments_) {
    for (double scatter : scatter_) {
      const Eigen::VectorXd known = information(moment, set, scatter);
      sum += variances<kMost>([&](Eigen::Index at) -> Pack { return Pack::Constant(known(at)); }, moment.drift)(0);
    }
  }
  return std::sqrt(sum / static_cast<double>(moments_.size() * scatter_.size() * static_cast<std::size_t>(n_drifts_)));
}

std::vector<double> ObserverLeft::with_each(std::span<const int> set) const {
  std::vector<Eigen::VectorXd> known;
  for (const Moment& moment : moments_) {
    for (double scatter : scatter_) known.push_back(information(moment, set, scatter));
  }
  const auto n = static_cast<double>(known.size() * static_cast<std::size_t>(n_drifts_));
  const Eigen::Index n_packs = moments_.front().told.rows() / kPack;
  std::vector<Pack> sums(static_cast<std::size_t>(n_packs), Pack::Zero());
  for_each_part(sums.size(), n_candidates_, [&](std::size_t pack) {
    const auto first = static_cast<Eigen::Index>(pack) * kPack;
    std::size_t i = 0;
    for (const Moment& moment : moments_) {
      for (std::size_t s = 0; s < scatter_.size(); ++s, ++i)
        sums[pack] += variances<kMost>(
            [&](Eigen::Index at) -> Pack {
              return known[i](at) + moment.told.col(at).template segment<kPack>(first).array();
            },
            moment.drift);
    }
  });
  std::vector<double> left;
  for (int c = 0; c < n_candidates_; ++c)
    left.push_back(std::sqrt(sums[static_cast<std::size_t>(c / kPack)](c % kPack) / n));
  return left;
}

}  // namespace driftwright::compensation
