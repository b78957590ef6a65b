#include "output/plot_axis.hpp"

#include <algorithm>
#include <cmath>

namespace driftwright::output {
namespace {

constexpr double kLargestDrawn = 1e300;  // ranges, and products with the size of the picture, stay finite
constexpr double kZero = 1e-280;         // smaller magnitudes are zero: 1e-12 of them is near the least double

}  // namespace

bool has_place(double value) {
  return std::abs(value) <= kLargestDrawn;  // NaN: false
}

void ValueRange::include(double value) {
  low = std::min(low, value);
  high = std::max(high, value);
}

ValueRange shown_range(const ValueRange& values, double margin, double least_difference) {
  if (values.is_empty()) return {0.0, 1.0};
  const double most = std::max(std::abs(values.low), std::abs(values.high)), difference = values.high - values.low;
  if (most < kZero) return {-1.0, 1.0};
  if (difference < least_difference * most) return {values.low - 0.05 * most, values.high + 0.05 * most};
  return {values.low - margin * difference, values.high + margin * difference};
}

}  // namespace driftwright::output
