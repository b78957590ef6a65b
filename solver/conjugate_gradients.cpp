#include "solver/conjugate_gradients.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace driftwright::solver {
namespace {

constexpr std::ptrdiff_t kBlock =
    4096;  // of unknowns; sums are made of blocks, so that any number of threads gives the same

template <int K>
using Lanes = std::array<double, K>;

/// Per vector: the sum over i of term(i, k).
template <int K, class Term>
Lanes<K> sum_over(std::ptrdiff_t n, const Term& term) {
  const std::ptrdiff_t n_blocks = (n + kBlock - 1) / kBlock;
  std::vector<Lanes<K>> partial(n_blocks);
#pragma omp parallel for schedule(static) if (n_blocks > 8)
  for (std::ptrdiff_t block = 0; block < n_blocks; ++block) {
    Lanes<K> sum{};
    const std::ptrdiff_t end = std::min(n, (block + 1) * kBlock);
    for (std::ptrdiff_t i = block * kBlock; i < end; ++i) {
      for (int k = 0; k < K; ++k) sum[k] += term(K * i + k, k);
    }
    partial[block] = sum;
  }
  Lanes<K> total{};
  for (const Lanes<K>& sum : partial) {
    for (int k = 0; k < K; ++k) total[k] += sum[k];
  }
  return total;
}

template <int K>
CgOutcome solve(std::ptrdiff_t n, const Operator& a, const Operator& precondition, const double* b, double* x,
                double tolerance, int max_iterations) {
  std::vector<double> r(b, b + n * K), z(n * K), p(n * K), q(n * K);
  std::fill(x, x + n * K, 0.0);
  CgOutcome outcome;
  precondition(r.data(), z.data());
  p = z;
  Lanes<K> rz = sum_over<K>(n, [&](std::ptrdiff_t i, int) { return r[i] * z[i]; });
  const Lanes<K> first = rz;
  while (true) {
    outcome.converged = true;
    for (int k = 0; k < K; ++k) {
      outcome.error[k] = first[k] == 0.0 ? 0.0 : std::sqrt(std::abs(rz[k] / first[k]));
      if (!(outcome.error[k] <= tolerance)) outcome.converged = false;
    }
    if (outcome.converged || outcome.iterations >= max_iterations) return outcome;
    if (std::any_of(outcome.error.begin(), outcome.error.end(), [](double e) { return !std::isfinite(e); })) return outcome;
    ++outcome.iterations;
    a(p.data(), q.data());
    const Lanes<K> pq = sum_over<K>(n, [&](std::ptrdiff_t i, int) { return p[i] * q[i]; });
    Lanes<K> alpha;
    for (int k = 0; k < K; ++k) alpha[k] = pq[k] > 0.0 ? rz[k] / pq[k] : 0.0;
#pragma omp parallel for schedule(static) if (n > kBlock)
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      for (int k = 0; k < K; ++k) {
        x[K * i + k] += alpha[k] * p[K * i + k];
        r[K * i + k] -= alpha[k] * q[K * i + k];
      }
    }
    precondition(r.data(), z.data());
    // r_new - r_old = -alpha q.
    const Lanes<K> rz_next = sum_over<K>(n, [&](std::ptrdiff_t i, int) { return r[i] * z[i]; });
    const Lanes<K> qz = sum_over<K>(n, [&](std::ptrdiff_t i, int) { return q[i] * z[i]; });
    Lanes<K> beta;
    for (int k = 0; k < K; ++k) beta[k] = rz[k] > 0.0 ? -alpha[k] * qz[k] / rz[k] : 0.0;
    rz = rz_next;
#pragma omp parallel for schedule(static) if (n > kBlock)
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      for (int k = 0; k < K; ++k) p[K * i + k] = z[K * i + k] + beta[k] * p[K * i + k];
    }
  }
}

}  // namespace

CgOutcome conjugate_gradients(int n, int n_vectors, const Operator& a, const Operator& precondition, const double* b,
                              double* x, double tolerance, int max_iterations) {
  if (n_vectors == 1) return solve<1>(n, a, precondition, b, x, tolerance, max_iterations);
  if (n_vectors == 4) return solve<4>(n, a, precondition, b, x, tolerance, max_iterations);
  throw std::logic_error("conjugate_gradients: one vector or four");
}

}  // namespace driftwright::solver
