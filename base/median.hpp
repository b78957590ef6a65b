#pragma once
// Median and quantile.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace driftwright {

/// The median; for an even number of values the upper of the two in the middle, for none 0.
[[nodiscard]] inline double upper_median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The smallest value that at least this share of the values does not exceed. @param values at least one; @param share above
/// 0, at most 1
[[nodiscard]] inline double quantile(std::vector<double> values, double share) {
  const auto n = static_cast<double>(values.size());
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max(std::ceil(share * n), 1.0)) - 1;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace driftwright
