#pragma once
// First guesses for conjugate gradients from the span of recent slopes. While temperatures drift smoothly, the increment of
// the next stage lies almost in this span. The best element of it costs about one matrix product and saves several
// iterations.
// Source: Fischer, Comput. Methods Appl. Mech. Engrg. 163 (1998) 193-204, with γ free to change.

#include <Eigen/Core>

#include "solver/sparse.hpp"

namespace driftwright::solver {

class Share;

/// The recent slopes, with their products with M and K.
class SlopeSpace {
 public:
  /// @param n      number of unknowns
  /// @param share  null: this process has all of them; else slopes are consistent, right-hand sides and residuals additive
  explicit SlopeSpace(int n, const Share* share = nullptr);

  /// Call when K has changed.
  void clear() {
    n_slopes_ = 0;
    newest_ = -1;
  }
  [[nodiscard]] bool empty() const { return n_slopes_ == 0; }
  /// Adds a slope; drops the oldest if there are more than kMost. M and K have the same pattern.
  void add(const SparseRow& mass, const SparseRow& stiffness, const double* slope);

  /// The x in the span with the smallest error of A x = b in the norm of A = M + γ K, and the residual b - A x.
  void guess(double gamma, const double* b, double* x, double* residual);

 private:
  static constexpr int kMost = 6;
  using Small = Eigen::Matrix<double, kMost, kMost>;

  int n_, n_slopes_ = 0, newest_ = -1;
  const Share* share_;
  Eigen::MatrixXd slope_, mass_slope_, stiffness_slope_;  ///< n x kMost
  Small mass_products_ = Small::Zero(), stiffness_products_ = Small::Zero();
  Eigen::MatrixXd block_sums_;  ///< 2 kMost x blocks
};

}  // namespace driftwright::solver
