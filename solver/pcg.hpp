#pragma once
// Conjugate gradients for M + gamma K, preconditioned by the diagonal, with the constant vector projected out of the
// residual, so that each solve conserves heat to rounding however loosely it is solved.

#include <Eigen/Core>

#include "solver/sparse.hpp"

namespace driftwright::solver {

struct PcgOutcome {
  int iterations = 0;
  double residual = 0.0;  ///< largest |r_i / A_ii|, in the unit of x
  bool converged = false;
};

class Pcg {
 public:
  /// @param a  symmetric positive definite; borrowed, and read again at each solve
  explicit Pcg(const SparseRow& a) : a_(a) {}

  /// Call when the values of the matrix have changed.
  /// @param ones  1 where heat is conserved, 0 at unknowns of prescribed temperature
  void refresh(const Eigen::VectorXd& ones);

  /// Solves A x = b from the x given. Stops when |r_i| <= tolerance A_ii for every row.
  [[nodiscard]] PcgOutcome solve(const double* b, double* x, double tolerance, int max_iterations);

 private:
  void project_constant(double* x);

  const SparseRow& a_;
  Eigen::VectorXd inverse_diagonal_, ones_, a_ones_;
  double ones_a_ones_ = 0.0;
  Eigen::VectorXd r_, z_, p_, q_;
};

}  // namespace driftwright::solver
