#include "solver/slope_space.hpp"

#include <cmath>

#include "base/dense.hpp"
#include "solver/share.hpp"

namespace driftwright::solver {

SlopeSpace::SlopeSpace(int n, const Share* share)
    : n_(n),
      share_(share),
      slope_(n, kMost),
      mass_slope_(n, kMost),
      stiffness_slope_(n, kMost),
      block_sums_(2 * kMost, n_blocks(n)) {}

void SlopeSpace::add(const SparseRow& mass, const SparseRow& stiffness, const double* slope) {
  newest_ = (newest_ + 1) % kMost;
  n_slopes_ = std::min(n_slopes_ + 1, kMost);
  const int* start = mass.outerIndexPtr();
  const int* column = mass.innerIndexPtr();
  const double* m = mass.valuePtr();
  const double* k = stiffness.valuePtr();
  double* of_mass = mass_slope_.col(newest_).data();
  double* of_stiffness = stiffness_slope_.col(newest_).data();
  std::copy(slope, slope + n_, slope_.col(newest_).data());
  for_blocks(n_, [&](int block, int begin, int end) {
    for (int row = begin; row < end; ++row) {
      double m_sum = 0.0, k_sum = 0.0;
      for (int e = start[row]; e < start[row + 1]; ++e) {
        m_sum += m[e] * slope[column[e]];
        k_sum += k[e] * slope[column[e]];
      }
      of_mass[row] = m_sum;
      of_stiffness[row] = k_sum;
    }
    const auto rows = Eigen::seqN(begin, end - begin);
    for (int j = 0; j < n_slopes_; ++j) {
      block_sums_(j, block) = slope_(rows, j).dot(mass_slope_(rows, newest_));
      block_sums_(kMost + j, block) = slope_(rows, j).dot(stiffness_slope_(rows, newest_));
    }
  });
  Eigen::VectorXd sums = block_sums_.rowwise().sum();
  if (share_) share_->sum(sums.data(), static_cast<int>(sums.size()));
  for (int j = 0; j < n_slopes_; ++j) {
    mass_products_(j, newest_) = mass_products_(newest_, j) = sums[j];
    stiffness_products_(j, newest_) = stiffness_products_(newest_, j) = sums[kMost + j];
  }
}

void SlopeSpace::guess(double gamma, const double* b, double* x, double* residual) {
  const int m = n_slopes_;
  for_blocks(n_, [&](int block, int begin, int end) {
    const Eigen::Map<const Eigen::VectorXd> of_block(b + begin, end - begin);
    for (int j = 0; j < m; ++j) block_sums_(j, block) = slope_.col(j).segment(begin, end - begin).dot(of_block);
  });
  Eigen::VectorXd projected = block_sums_.topRows(m).rowwise().sum();
  if (share_) share_->sum(projected.data(), m);
  const Eigen::MatrixXd a = (mass_products_ + gamma * stiffness_products_).topLeftCorner(m, m);
  // Slopes are almost parallel when little changes; combinations dominated by rounding are left out.
  constexpr double kLeastEigenvalue = 1e-9;
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(m);
  for (int j = 0; j < m; ++j) {
    if (a(j, j) > kLeastEigenvalue * kLeastEigenvalue * a.diagonal().maxCoeff()) unit[j] = 1.0 / std::sqrt(a(j, j));
  }
  const dense::SymmetricEigen parts(unit.asDiagonal() * a * unit.asDiagonal());
  Eigen::VectorXd share = parts.eigenvectors().transpose() * unit.cwiseProduct(projected);
  for (int j = 0; j < m; ++j) {
    const double eigenvalue = parts.eigenvalues()[j];
    share[j] = eigenvalue > kLeastEigenvalue ? share[j] / eigenvalue : 0.0;
  }
  const Eigen::VectorXd c = unit.cwiseProduct(parts.eigenvectors() * share);
  for_blocks(n_, [&](int, int begin, int end) {
    const int length = end - begin;
    Eigen::Map<Eigen::VectorXd> of_x(x + begin, length), of_r(residual + begin, length);
    of_x.setZero();
    of_r = Eigen::Map<const Eigen::VectorXd>(b + begin, length);
    for (int j = 0; j < m; ++j) {
      of_x += c[j] * slope_.col(j).segment(begin, length);
      of_r -= c[j] * (mass_slope_.col(j).segment(begin, length) + gamma * stiffness_slope_.col(j).segment(begin, length));
    }
  });
}

}  // namespace driftwright::solver
