#include "solver/conjugate_gradients.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/sparse.hpp"

namespace driftwright::solver {

CgOutcome conjugate_gradients(int n, const Operator& a, const Operator& precondition, const double* b, double* x,
                              double tolerance, int max_iterations) {
  std::vector<double> r(b, b + n), z(n), q(n);
  std::fill(x, x + n, 0.0);
  CgOutcome outcome;
  precondition(r.data(), z.data());
  std::vector<double> p = z;
  double rz = dot(r.data(), z.data(), n);
  const double first = rz;
  while (true) {
    outcome.error = first == 0.0 ? 0.0 : std::sqrt(rz / first);
    outcome.converged = outcome.error <= tolerance;
    // Also ends for NaN, and for a preconditioner or a matrix that is not positive.
    if (!(outcome.error > tolerance) || outcome.iterations >= max_iterations) return outcome;
    ++outcome.iterations;
    a(p.data(), q.data());
    const double alpha = rz / dot(p.data(), q.data(), n);
    for_each_index(n, n > kWorthThreads, [&, alpha](int i) {
      x[i] += alpha * p[i];
      r[i] -= alpha * q[i];
    });
    precondition(r.data(), z.data());
    const double beta = -alpha * dot(q.data(), z.data(), n) / rz;  // r has changed by -alpha q
    rz = dot(r.data(), z.data(), n);
    for_each_index(n, n > kWorthThreads, [&, beta](int i) { p[i] = z[i] + beta * p[i]; });
  }
}

}  // namespace driftwright::solver
