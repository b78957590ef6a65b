#pragma once
// A mean and how well it is known.

#include <cstddef>
#include <span>

namespace driftwright {

struct MeanError {
  double mean = 0.0, standard_error = 0.0;  ///< of fewer than two values the error is 0
  std::size_t n = 0;
};

/// Of the values that are finite.
[[nodiscard]] MeanError mean_error(std::span<const double> values);

/// What the mean exceeds with 95 % where the values are independent and normal: the lower end of Student's one-sided interval; of fewer than two values -infinity.
[[nodiscard]] double surely_above(const MeanError& error);

}  // namespace driftwright
