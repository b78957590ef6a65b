#include "solver/exponentials.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace driftwright::solver {
namespace {

constexpr int kBlock =
    4;  // blocks of the series, with as many terms each: for a norm of at most 1 the truncation error is 1/18! of 1

/// 1/k! for k from 0.
constexpr auto kInverseFactorial = [] {
  std::array<double, kBlock * kBlock + 2> f{};
  f[0] = 1.0;
  for (std::size_t k = 1; k < f.size(); ++k) f[k] = f[k - 1] / static_cast<double>(k);
  return f;
}();

/// @param x  whose norm is at most 1
Exponentials by_series(const Eigen::MatrixXd& x) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(x.rows(), x.cols()), x2 = x * x, x3 = x2 * x, x4 = x2 * x2;
  Exponentials e;
  for (int block = kBlock - 1; block >= 0; --block) {  // φ2 = Σ X^k / (k + 2)!
    const double* c = &kInverseFactorial[static_cast<std::size_t>(kBlock * block + 2)];
    Eigen::MatrixXd sum = c[0] * one + c[1] * x + c[2] * x2 + c[3] * x3;
    if (block < kBlock - 1) sum.noalias() += x4 * e.phi2;
    e.phi2 = std::move(sum);
  }
  e.phi1 = one + x * e.phi2;
  e.exp = one + x * e.phi1;
  return e;
}

}  // namespace

Exponentials doubled(const Exponentials& of_x) {
  const auto n = of_x.exp.rows();
  Exponentials e;
  e.phi2.noalias() = 0.25 * of_x.phi1 * of_x.phi1;
  e.phi2 += 0.5 * of_x.phi2;
  e.phi1.noalias() = 0.5 * (of_x.exp + Eigen::MatrixXd::Identity(n, n)) * of_x.phi1;
  e.exp.noalias() = of_x.exp * of_x.exp;
  return e;
}

std::vector<Exponentials> exponentials_and_halves(const Eigen::MatrixXd& x) {
  const double norm = x.cwiseAbs().rowwise().sum().maxCoeff();
  const int n_doublings = norm > 1.0 ? static_cast<int>(std::ceil(std::log2(norm))) : 0;
  std::vector<Exponentials> all{by_series(std::ldexp(1.0, -n_doublings) * x)};
  for (int i = 0; i < n_doublings; ++i) all.push_back(doubled(all.back()));
  std::reverse(all.begin(), all.end());
  return all;
}

Exponentials exponentials(const Eigen::MatrixXd& x) {
  return std::move(exponentials_and_halves(x).front());
}

}  // namespace driftwright::solver
