#pragma once
// One number that the diagnosis may turn: what it is called, how well it is known, what turning it does.

#include <functional>
#include <string>
#include <vector>

#include "effects/doubt.hpp"

namespace driftwright::diagnosis {

/// Everything that a machine may be doubted to be: the scenario's effects, numbers of which may be others, in their order, and behind them those
/// that it has beside.
using TwinState = std::vector<effects::Effect>;

/// x = 0 is what the scenario says; the search turns x.
struct Knob {
  std::string effect;  ///< catalogue key that a value far off is called
  std::string where;
  std::string name, unit;  ///< of the value
  std::string in = {};     ///< the run whose own number it is; "": of all
  enum class Scale { kLog, kLinear } scale = Scale::kLinear;
  double nominal = 0.0;               ///< value at x = 0
  double prior_sd = 1.0;              ///< of x
  double step = 0.1;                  ///< of x, for differences
  double low = -1e300, high = 1e300;  ///< of the value
  bool is_time = false;               ///< found by search, not by slopes
  bool grows_with_size = false;       ///< where to look first, in proportion to the claim's size; of kLog
  bool reading_only = false;          ///< the machine's own response does not change
  std::function<void(TwinState&, double value)> set = {};

  /// The time of a jump in a reading has no slope: its misfit is flat between two rows.
  [[nodiscard]] bool is_jump() const { return is_time && reading_only; }
  [[nodiscard]] double value(double x) const;
  /// The x of a value.
  [[nodiscard]] double x(double value) const;
};

}  // namespace driftwright::diagnosis
