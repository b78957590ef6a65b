#include "base/designs.hpp"

#include <fmt/format.h>

#include <array>
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

double polynomial(const std::array<double, 8>& c, double x) {
  double sum = 0.0;
  for (auto i = c.rbegin(); i != c.rend(); ++i) sum = sum * x + *i;
  return sum;
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

double normal_quantile(double p) {
  if (!(p > 0.0 && p < 1.0))
    throw RangeError(fmt::format("no normal number has probability {:g}; it must be above 0 and below 1", p));
  const double q = p - 0.5;
  if (std::abs(q) <= 0.425) {
    const double r = 0.180625 - q * q;
    return q *
           polynomial(
               {3.3871328727963666080e0, 1.3314166789178437745e+2, 1.9715909503065514427e+3, 1.3731693765509461125e+4,
                4.5921953931549871457e+4, 6.7265770927008700853e+4, 3.3430575583588128105e+4, 2.5090809287301226727e+3},
               r) /
           polynomial(
               {1.0, 4.2313330701600911252e+1, 6.8718700749205790830e+2, 5.3941960214247511077e+3, 2.1213794301586595867e+4,
                3.9307895800092710610e+4, 2.8729085735721942674e+4, 5.2264952788528545610e+3},
               r);
  }
  double r = std::sqrt(-std::log(q < 0.0 ? p : 1.0 - p)), x = 0.0;
  if (r <= 5.0) {
    r -= 1.6;
    x = polynomial(
            {1.42343711074968357734e0, 4.63033784615654529590e0, 5.76949722146069140550e0, 3.64784832476320460504e0,
             1.27045825245236838258e0, 2.41780725177450611770e-1, 2.27238449892691845833e-2, 7.74545014278341407640e-4},
            r) /
        polynomial(
            {1.0, 2.05319162663775882187e0, 1.67638483018380384940e0, 6.89767334985100004550e-1, 1.48103976427480074590e-1,
             1.51986665636164571966e-2, 5.47593808499534494600e-4, 1.05075007164441684324e-9},
            r);
  } else {
    r -= 5.0;
    x = polynomial(
            {6.65790464350110377720e0, 5.46378491116411436990e0, 1.78482653991729133580e0, 2.96560571828504891230e-1,
             2.65321895265761230930e-2, 1.24266094738807843860e-3, 2.71155556874348757815e-5, 2.01033439929228813265e-7},
            r) /
        polynomial(
            {1.0, 5.99832206555887937690e-1, 1.36929880922735805310e-1, 1.48753612908506148525e-2, 7.86869131145613259100e-4,
             1.84631831751005468180e-5, 1.42151175831644588870e-7, 2.04426310338993978564e-15},
            r);
  }
  return q < 0.0 ? -x : x;
}

}  // namespace driftwright
