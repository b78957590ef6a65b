#pragma once
// Conjugate gradients for M + gamma K, preconditioned by the diagonal or by multigrid, with the constant vector projected
// out of the residual, so that each solve conserves heat up to rounding, even with a loose tolerance.

#include <Eigen/Core>

#include "solver/sparse.hpp"

namespace driftwright::solver {

class Preconditioner;
class Share;

struct PcgOutcome {
  int iterations = 0;
  double residual = 0.0;  ///< largest |r_i / scale_i|, in the unit of x
  bool converged = false;
};

/// The solver for one matrix.
class Pcg {
 public:
  /// @param a      symmetric positive definite; borrowed, and read again at each solve
  /// @param share  a is the additive part of this process (share.hpp): residuals and solutions are then consistent; null:
  ///               the whole
  explicit Pcg(const SparseRow& a, const Share* share = nullptr) : a_(a), share_(share) {}

  /// Call when the values of the matrix have changed.
  /// @param ones   1 where heat is conserved, 0 at unknowns of prescribed temperature
  /// @param scale  the unit of residuals, row by row [J/K, the unit of A]; empty: the diagonal of A. Consistent
  void refresh(const Eigen::VectorXd& ones, const Eigen::VectorXd& scale = {});

  /// Solves A x = b from the x given; b is additive. Stops when |r_i| <= tolerance scale_i for every row.
  [[nodiscard]] PcgOutcome solve(const double* b, double* x, double tolerance, int max_iterations);
  /// The same if b - A x is known.
  /// @param r  in: b - A x at the given x; out: at the solution
  /// @param multigrid  or another preconditioner, of a matrix close to A; nullptr for the diagonal
  /// @param least_iterations  that are made however small the residual is, unless it is zero
  [[nodiscard]] PcgOutcome improve(double* r, double* x, double tolerance, int max_iterations,
                                   const Preconditioner* multigrid = nullptr, int least_iterations = 0);
  /// Adds a constant to x such that the sum of A x equals the sum of b; this removes rounding errors of residuals that were
  /// updated step by step. @param b  additive
  void conserve(const double* b, double* x) const;

 private:
  struct Sums {
    double rz = 0.0, largest = 0.0;
  };
  void project_constant(double* r, double* x) const;
  [[nodiscard]] double multiply_p();
  [[nodiscard]] Sums start(const double* r, const Preconditioner* multigrid);
  [[nodiscard]] Sums advance(double alpha, double* r, double* x, const Preconditioner* multigrid);
  void turn(double beta, const double* r, const Preconditioner* multigrid);
  [[nodiscard]] Sums sum_blocks(bool with_rz) const;
  /// Over all processes: r.z of what each one holds, the largest residual.
  [[nodiscard]] Sums of_all(const Sums& own, const double* r, bool by_diagonal) const;
  [[nodiscard]] int n_held() const;
  [[nodiscard]] double of_all(double own) const;

  const SparseRow& a_;
  const Share* share_;
  Eigen::VectorXd inverse_diagonal_, inverse_scale_, ones_, a_ones_;
  double ones_a_ones_ = 0.0;
  Eigen::VectorXd r_, z_, p_, q_;
  std::vector<double> block_sum_, block_largest_;  ///< partial results of fixed blocks of rows
};

}  // namespace driftwright::solver
