#include "solver/pcg.hpp"

#include <cmath>

namespace driftwright::solver {

void Pcg::refresh(const Eigen::VectorXd& ones) {
  const int n = static_cast<int>(a_.rows());
  inverse_diagonal_ = a_.diagonal().cwiseInverse();
  a_ones_.resize(n);
  ones_ = ones;
  multiply(a_, ones.data(), a_ones_.data());
  ones_a_ones_ = ones.dot(a_ones_);
  r_.resize(n);
  z_.resize(n);
  p_.resize(n);
  q_.resize(n);
}

void Pcg::project_constant(double* x) {  // x += c so that the residual sums to zero: no heat is made or lost
  const int n = static_cast<int>(r_.size());
  const double c = ones_a_ones_ > 0.0 ? ones_.dot(r_) / ones_a_ones_ : 0.0;  // zero where every unknown is prescribed
  Eigen::Map<Eigen::VectorXd>(x, n) += c * ones_;
  r_ -= c * a_ones_;
}

PcgOutcome Pcg::solve(const double* b, double* x, double tolerance, int max_iterations) {
  const int n = static_cast<int>(r_.size());
  multiply(a_, x, q_.data());
  r_ = Eigen::Map<const Eigen::VectorXd>(b, n) - q_;
  project_constant(x);
  PcgOutcome outcome;
  z_ = inverse_diagonal_.cwiseProduct(r_);
  p_ = z_;
  double rz = dot(r_.data(), z_.data(), n);
  while (true) {
    outcome.residual = z_.cwiseAbs().maxCoeff();
    if (outcome.residual <= tolerance) outcome.converged = true;
    if (!(outcome.residual > tolerance) || outcome.iterations >= max_iterations) break;  // NaN ends it too
    ++outcome.iterations;
    multiply(a_, p_.data(), q_.data());
    const double alpha = rz / dot(p_.data(), q_.data(), n);
    double* const r = r_.data();
    double* const z = z_.data();
    const double* const p = p_.data();
    const double* const q = q_.data();
    const double* const d = inverse_diagonal_.data();
#pragma omp parallel for simd schedule(static) if (n > kWorthThreads)
    for (int i = 0; i < n; ++i) {
      x[i] += alpha * p[i];
      r[i] -= alpha * q[i];
      z[i] = d[i] * r[i];
    }
    const double rz_next = dot(r, z, n);
    const double beta = rz_next / rz;
    rz = rz_next;
    double* const p_next = p_.data();
#pragma omp parallel for simd schedule(static) if (n > kWorthThreads)
    for (int i = 0; i < n; ++i) p_next[i] = z[i] + beta * p_next[i];
  }
  project_constant(x);
  return outcome;
}

}  // namespace driftwright::solver
