#pragma once
// Preconditioned conjugate gradients for one right-hand side, or for four at once that share each pass over the matrix.

#include <array>
#include <functional>

namespace driftwright::solver {

/// y = (operator) x for the interleaved vectors.
using Operator = std::function<void(const double* x, double* y)>;

/// Per right-hand side.
struct CgOutcome {
  int iterations = 0;
  std::array<double, 4> error = {};  ///< estimate of |x - A⁻¹b| / |A⁻¹b| in the norm of A, as in the tolerance
  bool converged = false;            ///< all of them
};

/// Solves A x = b from x = 0 for n_vectors (1 or 4) interleaved vectors of n numbers each: x[n_vectors i + k].
///
/// Stops when sqrt(r'Br) <= tolerance sqrt(b'Bb) for each, r the residual and B the preconditioner: where B is close to A⁻¹ these
/// are the lengths of error and solution in the norm of A. Right-hand sides of zero have the solution zero. B may change
/// a little from one application to the next (rounding in single precision): the directions are kept conjugate by Polak and
/// Ribière's formula.
[[nodiscard]] CgOutcome conjugate_gradients(int n, int n_vectors, const Operator& a, const Operator& precondition,
                                            const double* b, double* x, double tolerance, int max_iterations);

}  // namespace driftwright::solver
