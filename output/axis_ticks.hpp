#pragma once
// Ticks of an axis at round numbers, and their labels.

#include <string>
#include <vector>

namespace driftwright::output {

/// Ticks in rising order; all are multiples of `step`.
struct AxisTicks {
  double step = 0.0;  ///< 1, 2 or 5 times a power of ten; 2.5 times one where none of these gives 4 to 9 ticks
  std::vector<double> values = {};
  std::vector<std::string> labels = {};  ///< one a tick, all with the same number of decimals; the minus sign is U+2212
};

/// All multiples of a round step from `low` to `high`: 4 to 9 of them, as near to `preferred` as possible. The ends of the
/// axis are less than a step away from the first and the last tick. Labels are decimal numbers or, if these are long, of the
/// form 2e9 or 1.5e−7.
/// @param low, high  low < high; at most 1e302 in magnitude; high - low at least 1e-293, and 1e-12 of the larger magnitude
/// @param preferred  number of ticks for which there is room; > 0
/// @throws std::logic_error  when the range is empty, or too small or too large for doubles
/// Source of the round steps: Heckbert, "Nice numbers for graph labels", Graphics Gems (1990) 61-63.
[[nodiscard]] AxisTicks axis_ticks(double low, double high, double preferred);

}  // namespace driftwright::output
