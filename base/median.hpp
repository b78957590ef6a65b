#pragma once
// The value in the middle.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace driftwright {

/// The middle of the values in order; of an even number of them the upper of the two in the middle, of none 0.
[[nodiscard]] inline double upper_median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace driftwright
