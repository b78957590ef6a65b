#include "base/designs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <random>

#include "base/errors.hpp"

namespace driftwright {
namespace {

/// Uniform among 0 ... n - 1; random numbers of the last, incomplete range are rejected.
std::uint64_t below(std::uint64_t n, std::mt19937_64& random) {
  const std::uint64_t most = std::mt19937_64::max();
  const std::uint64_t last = most - (most % n + 1) % n;
  std::uint64_t number = random();
  while (number > last) number = random();
  return number % n;
}

}  // namespace

std::vector<double> linear_steps(double from, double to, int n) {
  std::vector<double> values;
  for (int i = 0; i < n; ++i) values.push_back(i == n - 1 ? to : from + (to - from) * i / (n - 1));
  return values;
}

std::vector<double> log_steps(double from, double to, int n) {
  if (!(from > 0.0 && to > 0.0))
    throw RangeError(fmt::format("{:g} to {:g} has no logarithm; both must be above 0", from, to));
  std::vector<double> values;
  for (int i = 0; i < n; ++i)
    values.push_back(i == 0 ? from : i == n - 1 ? to : from * std::pow(to / from, double(i) / (n - 1)));
  return values;
}

std::vector<std::size_t> grid_point(std::size_t point, const std::vector<std::size_t>& sizes) {
  std::vector<std::size_t> index(sizes.size());
  for (std::size_t i = sizes.size(); i-- > 0;) {
    index[i] = point % sizes[i];
    point /= sizes[i];
  }
  return index;
}

Eigen::MatrixXd latin_hypercube(int n_samples, int n_variables, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Eigen::MatrixXd samples(n_samples, n_variables);
  std::vector<int> stratum(static_cast<std::size_t>(n_samples));
  for (int j = 0; j < n_variables; ++j) {
    std::iota(stratum.begin(), stratum.end(), 0);
    for (std::size_t i = stratum.size(); i > 1; --i) std::swap(stratum[i - 1], stratum[below(i, random)]);
    for (int i = 0; i < n_samples; ++i) {
      // 33 bits within a stratum and 20 for its number are exact in a double, so no number gets into the next stratum.
      const double within = std::ldexp(static_cast<double>(random() >> 32) + 0.5, -32);
      samples(i, j) = (stratum[static_cast<std::size_t>(i)] + within) / n_samples;
    }
  }
  return samples;
}

Eigen::MatrixXd saltelli_design(int n_samples, int n_variables, std::uint64_t seed) {
  const Eigen::MatrixXd both = latin_hypercube(n_samples, 2 * n_variables, seed);
  const auto a = both.leftCols(n_variables), b = both.rightCols(n_variables);
  Eigen::MatrixXd design((n_variables + 2) * n_samples, n_variables);
  design.topRows(n_samples) = a;
  design.middleRows(n_samples, n_samples) = b;
  for (int i = 0; i < n_variables; ++i) {
    auto mixed = design.middleRows((2 + i) * n_samples, n_samples);
    mixed = a;
    mixed.col(i) = b.col(i);
  }
  return design;
}

}  // namespace driftwright
