#pragma once
// A mean and its standard error.

#include <cstddef>
#include <span>

namespace driftwright {

/// Mean, standard error and number of values.
struct MeanError {
  double mean = 0.0, standard_error = 0.0;  ///< the error is 0 for fewer than two values
  std::size_t n = 0;
};

/// Mean and standard error of the finite values.
[[nodiscard]] MeanError mean_error(std::span<const double> values);

/// Lower limit of the mean with 95 % confidence (Student's one-sided interval), for independent normal values; -infinity for
/// fewer than two values.
[[nodiscard]] double surely_above(const MeanError& error);

/// Quantile of Student's t. @param degrees  of freedom, above 0. @param share  in (0, 1)
[[nodiscard]] double student_quantile(double degrees, double share);

}  // namespace driftwright
