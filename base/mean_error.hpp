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

}  // namespace driftwright
