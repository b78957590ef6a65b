#pragma once
// Preconditioned conjugate gradients for matrices and preconditioners that are given as functions.

#include <functional>

namespace driftwright::solver {

/// y = (operator) x.
using Operator = std::function<void(const double* x, double* y)>;

struct CgOutcome {
  int iterations = 0;
  double error = 0.0;  ///< sqrt(r'Br / b'Bb) at the end
  bool converged = false;
};

/// Solves A x = b for n unknowns from x = 0.
///
/// Stops when sqrt(r'Br) <= tolerance sqrt(b'Bb), with the residual r and the preconditioner B. If B is close to A⁻¹, these
/// are the lengths of error and solution in the norm of A. B may change slightly from one application to the next (rounding
/// in single precision): the directions are kept conjugate by the formula of Polak and Ribière.
[[nodiscard]] CgOutcome conjugate_gradients(int n, const Operator& a, const Operator& precondition, const double* b,
                                            double* x, double tolerance, int max_iterations);

}  // namespace driftwright::solver
