#pragma once
// First guesses of conjugate gradients from the span of recent slopes. While temperatures drift smoothly, what the next stage adds
// lies nearly in that span, and the best of it costs a few dot products: about one product with a matrix, for several iterations.
// Source: Fischer, Comput. Methods Appl. Mech. Engrg. 163 (1998) 193-204, with γ free to change.

#include <Eigen/Core>

#include "solver/sparse.hpp"

namespace driftwright::solver {

class SlopeSpace {
 public:
  /// @param n  unknowns
  explicit SlopeSpace(int n);

  /// Call when K has changed.
  void clear() {
    n_slopes_ = 0;
    newest_ = -1;
  }
  [[nodiscard]] bool empty() const { return n_slopes_ == 0; }
  /// Adds a slope and drops the oldest. M and K have the same pattern.
  void add(const SparseRow& mass, const SparseRow& stiffness, const double* slope);

  /// The x of the span with the least error in the norm of A = M + γ K for A x = b, and b - A x.
  void guess(double gamma, const double* b, double* x, double* residual);

 private:
  static constexpr int kMost = 6;
  using Small = Eigen::Matrix<double, kMost, kMost>;

  int n_, n_slopes_ = 0, newest_ = -1;
  Eigen::MatrixXd slope_, mass_slope_, stiffness_slope_;  ///< n x kMost
  Small mass_products_ = Small::Zero(), stiffness_products_ = Small::Zero();
  Eigen::MatrixXd block_sums_;  ///< 2 kMost x blocks
};

}  // namespace driftwright::solver
