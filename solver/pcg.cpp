#include "solver/pcg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/share.hpp"

namespace driftwright::solver {

// Each loop runs over the fixed blocks of sparse.hpp and stores one partial sum per block, so that the sums do not depend on
// the number of threads. Operations that can share a pass over the vectors do so.

void Pcg::refresh(const Eigen::VectorXd& ones, const Eigen::VectorXd& scale) {
  const int n = static_cast<int>(a_.rows());
  inverse_diagonal_ = a_.diagonal();
  if (share_) share_->add_copies(inverse_diagonal_);
  inverse_diagonal_ = inverse_diagonal_.cwiseInverse().eval();
  inverse_scale_ = scale.size() > 0 ? scale.cwiseInverse() : inverse_diagonal_;
  a_ones_.resize(n);
  ones_ = ones;
  multiply(a_, ones.data(), a_ones_.data());
  ones_a_ones_ = of_all(ones.dot(a_ones_));
  if (share_) share_->add_copies(a_ones_);
  r_.resize(n);
  z_.resize(n);
  p_.resize(n);
  q_.resize(n);
  block_sum_.resize(n_blocks(n));
  block_largest_.resize(n_blocks(n));
}

void Pcg::project_constant(double* r, double* x) const {  // x += c so that r sums to zero: heat is conserved
  const int n = static_cast<int>(ones_.size());
  if (!(ones_a_ones_ > 0.0)) return;  // every unknown is prescribed
  const double c = of_all(dot(ones_.data(), r, n_held())) / ones_a_ones_;
  Eigen::Map<Eigen::VectorXd>(x, n) += c * ones_;
  Eigen::Map<Eigen::VectorXd>(r, n) -= c * a_ones_;
}

void Pcg::conserve(const double* b, double* x) const {
  const int n = static_cast<int>(ones_.size());
  if (!(ones_a_ones_ > 0.0)) return;
  const double c = of_all(dot(ones_.data(), b, n) - dot(a_ones_.data(), x, n_held())) / ones_a_ones_;
  Eigen::Map<Eigen::VectorXd>(x, n) += c * ones_;
}

int Pcg::n_held() const {
  return share_ ? share_->n_held : static_cast<int>(ones_.size());
}

double Pcg::of_all(double own) const {
  return share_ ? share_->sum(own) : own;
}

Pcg::Sums Pcg::of_all(const Sums& own, const double* r, bool by_diagonal) const {
  if (!share_) return own;
  const auto n = static_cast<Eigen::Index>(n_held());
  const Eigen::Map<const Eigen::VectorXd> held(r, n);
  const double rz = by_diagonal ? held.cwiseAbs2().dot(inverse_diagonal_.head(n)) : held.dot(z_.head(n));
  const auto [sum, largest] = share_->sum_and_largest(rz, own.largest);
  return {sum, largest};
}

Pcg::Sums Pcg::sum_blocks(bool with_rz) const {
  Sums sums;
  for (std::size_t b = 0; b < block_sum_.size(); ++b) {
    if (with_rz) sums.rz += block_sum_[b];
    // Written so that NaN is accepted, too.
    if (!(block_largest_[b] <= sums.largest)) sums.largest = block_largest_[b];
  }
  return sums;
}

double Pcg::multiply_p() {  // q = A p, and p . q
  const int n = static_cast<int>(p_.size());
  const int* start = a_.outerIndexPtr();
  const int* column = a_.innerIndexPtr();
  const double* value = a_.valuePtr();
  const double* p = p_.data();
  double* q = q_.data();
  for_blocks(n, [&](int block, int begin, int end) {
    double sum = 0.0;
    for (int row = begin; row < end; ++row) {
      const double product = times_row(value, column, start[row], start[row + 1], p);
      q[row] = product;
      sum += p[row] * product;
    }
    block_sum_[block] = sum;
  });
  double sum = 0.0;
  for (double of_block : block_sum_) sum += of_block;
  if (share_) share_->add_copies(q_);
  return of_all(sum);
}

Pcg::Sums Pcg::start(const double* r, const Preconditioner* multigrid) {  // p = B r
  const int n = static_cast<int>(p_.size());
  if (multigrid) multigrid->precondition(r, z_.data());
  for_blocks(n, [&](int block, int begin, int end) {
    double sum = 0.0, largest = 0.0;
    for (int i = begin; i < end; ++i) {
      const double z = multigrid ? z_[i] : inverse_diagonal_[i] * r[i];
      p_[i] = z;
      sum += r[i] * z;
      const double scaled = std::abs(r[i]) * inverse_scale_[i];
      if (!(scaled <= largest)) largest = scaled;
    }
    block_sum_[block] = sum;
    block_largest_[block] = largest;
  });
  return of_all(sum_blocks(true), r, multigrid == nullptr);
}

Pcg::Sums Pcg::advance(double alpha, double* r, double* x, const Preconditioner* multigrid) {
  const int n = static_cast<int>(p_.size());
  const double* p = p_.data();
  const double* q = q_.data();
  const double* d = inverse_diagonal_.data();
  const double* s = inverse_scale_.data();
  for_blocks(n, [&](int block, int begin, int end) {
    double sum = 0.0, largest = 0.0;
#pragma omp simd reduction(+ : sum) reduction(max : largest)
    for (int i = begin; i < end; ++i) {
      x[i] += alpha * p[i];
      const double next = r[i] - alpha * q[i];
      r[i] = next;
      sum += next * next * d[i];
      largest = std::max(largest, std::abs(next) * s[i]);
    }
    block_sum_[block] = sum;
    block_largest_[block] = std::isfinite(sum) ? largest : sum;  // max() loses NaN
  });
  Sums sums = sum_blocks(true);
  if (multigrid) {
    multigrid->precondition(r, z_.data());
    sums.rz = dot(r, z_.data(), n);
  }
  return of_all(sums, r, multigrid == nullptr);
}

void Pcg::turn(double beta, const double* r, const Preconditioner* multigrid) {
  const int n = static_cast<int>(p_.size());
  double* p = p_.data();
  const double* z = z_.data();
  const double* d = inverse_diagonal_.data();
  for_blocks(n, [&](int, int begin, int end) {
    if (multigrid) {
#pragma omp simd
      for (int i = begin; i < end; ++i) p[i] = z[i] + beta * p[i];
    } else {
#pragma omp simd
      for (int i = begin; i < end; ++i) p[i] = d[i] * r[i] + beta * p[i];
    }
  });
}

PcgOutcome Pcg::improve(double* r, double* x, double tolerance, int max_iterations, const Preconditioner* multigrid,
                        int least_iterations) {
  project_constant(r, x);
  PcgOutcome outcome;
  Sums sums = start(r, multigrid);
  while (true) {
    outcome.residual = sums.largest;
    if (outcome.residual <= tolerance) outcome.converged = true;
    const bool is_required = outcome.iterations < least_iterations && sums.rz > std::numeric_limits<double>::min();
    if (!(outcome.residual > tolerance || is_required) || outcome.iterations >= max_iterations) break;  // also ends for NaN
    ++outcome.iterations;
    const double alpha = sums.rz / multiply_p();
    const double rz = sums.rz;
    sums = advance(alpha, r, x, multigrid);
    if (!(sums.largest <= tolerance) || outcome.iterations < least_iterations) turn(sums.rz / rz, r, multigrid);
  }
  project_constant(r, x);
  return outcome;
}

PcgOutcome Pcg::solve(const double* b, double* x, double tolerance, int max_iterations) {
  multiply(a_, x, q_.data());
  r_ = Eigen::Map<const Eigen::VectorXd>(b, r_.size()) - q_;
  if (share_) share_->add_copies(r_);
  return improve(r_.data(), x, tolerance, max_iterations);
}

}  // namespace driftwright::solver
