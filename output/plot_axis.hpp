#pragma once
// What an axis of a plot shows, and where a value is on it.

#include <limits>

namespace driftwright::output {

/// Does a value have a place on an axis? NaN, infinite values and those beyond 1e300 in magnitude have none.
[[nodiscard]] bool has_place(double value);

/// The values that an axis must show. Empty (low > high) until one is included.
struct ValueRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  [[nodiscard]] bool is_empty() const { return low > high; }
  void include(double value);
};

/// The range of an axis: `values` widened by `margin` of their range at both ends. Values that differ by less than
/// `least_difference` of the largest magnitude count as equal, and the axis then goes 5 % of that magnitude beyond them
/// (zero: -1 to 1), so that noise in the last digits of a constant curve does not fill the plot. Without values: 0 to 1.
/// @param least_difference  >= 1e-12, which axis_ticks() needs
[[nodiscard]] ValueRange shown_range(const ValueRange& values, double margin, double least_difference);

/// Maps `range` to pixels linearly: low to `low_px`, high to `high_px`.
struct AxisScale {
  ValueRange range = {};
  double low_px = 0.0, high_px = 0.0;

  [[nodiscard]] double operator()(double value) const {
    return low_px + (value - range.low) / (range.high - range.low) * (high_px - low_px);
  }
};

}  // namespace driftwright::output
