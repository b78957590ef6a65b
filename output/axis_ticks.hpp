#pragma once
// Ticks of an axis at round numbers, and their labels.

#include <string>
#include <vector>

namespace driftwright::output {

/// Ticks in rising order; all are multiples of `step`.
struct AxisTicks {
  double step = 0.0;  ///< of TickSteps; where none of these gives 4 to 9 ticks, 1, 2, 2.5 or 5 times a power of ten
  std::vector<double> values = {};
  std::vector<std::string> labels = {};  ///< one a tick, all with the same number of decimals; the minus sign is U+2212
};

/// Which steps are round on an axis.
enum class TickSteps {
  kDecimal,  ///< 1, 2 or 5 times a power of ten
  kMinutes,  ///< up to 10 min as numbers; 15, 30, 60 min, 2, 3, 6, 12 h; 1, 2, 5, 10 ... days
  kHours,    ///< up to 0.1 h as numbers; 0.25, 0.5, 1, 2, 3, 6, 12 h; 1, 2, 5, 10 ... days
};

/// All multiples of a round step from `low` to `high`: 4 to 9 of them, as near to `preferred` as possible. The ends of the
/// axis are less than a step away from the first and the last tick. Labels are decimal numbers or, if these are long, of the
/// form 2e9 or 1.5e−7.
/// @param low, high  low < high; at most 1e302 in magnitude; high - low at least 1e-293, and 1e-12 of the larger magnitude
/// @param preferred  number of ticks for which there is room; > 0
/// @throws std::logic_error  when the range is empty, or too small or too large for doubles
/// Source of the round steps: Heckbert, "Nice numbers for graph labels", Graphics Gems (1990) 61-63.
[[nodiscard]] AxisTicks axis_ticks(double low, double high, double preferred, TickSteps steps = TickSteps::kDecimal);

}  // namespace driftwright::output
