#include "base/mean_error.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace driftwright {

MeanError mean_error(std::span<const double> values) {
  MeanError result;
  for (double v : values) result.n += std::isfinite(v) ? 1 : 0;
  if (result.n == 0) return result;
  const auto n = static_cast<double>(result.n);
  for (double v : values) {
    if (std::isfinite(v)) result.mean += v / n;
  }
  double squares = 0.0;
  for (double v : values) {
    if (std::isfinite(v)) squares += (v - result.mean) * (v - result.mean);
  }
  if (result.n > 1) result.standard_error = std::sqrt(squares / (n - 1.0) / n);
  return result;
}

double surely_above(const MeanError& error) {
  if (error.n < 2) return -std::numeric_limits<double>::infinity();
  return error.mean - student_quantile(static_cast<double>(error.n - 1), 0.95) * error.standard_error;
}

double student_quantile(double degrees, double share) {
  return boost::math::quantile(boost::math::students_t(degrees), share);
}

}  // namespace driftwright
