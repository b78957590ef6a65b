#pragma once
// One number that the diagnosis may change: its name, prior, and the effect of a change.

#include <functional>
#include <string>
#include <vector>

#include "effects/doubt.hpp"

namespace driftwright::diagnosis {

/// A possible machine: the scenario's effects in their order, possibly with other numbers, followed by added effects.
using TwinState = std::vector<effects::Effect>;

/// x = 0 is the scenario's value; the search varies x.
struct Knob {
  std::string effect;  ///< catalogue key that names a value far from nominal
  std::string where;
  std::string name, unit;  ///< of the value
  std::string in = {};     ///< the run that the number belongs to; "": all
  enum class Scale { kLog, kLinear } scale = Scale::kLinear;
  double nominal = 0.0;               ///< value at x = 0
  double prior_sd = 1.0;              ///< of x
  double step = 0.1;                  ///< of x, for finite differences
  double low = -1e300, high = 1e300;  ///< of the value
  bool is_time = false;               ///< found by search, since it has no slope
  bool grows_with_size = false;       ///< its starting value is proportional to the claim's size; for kLog
  bool reading_only = false;          ///< the machine's own response is unchanged
  std::function<void(TwinState&, double value)> set = {};
  std::string own = {};  ///< kind of the scenario's effect whose number it is, as its file has it; "": of none
  int line = 0;          ///< of that effect's first key in the file
  bool is_said = false;  ///< the scenario says with `known_to` how well it is known

  /// The time of a jump in a reading has no slope: the misfit is constant between two rows.
  [[nodiscard]] bool is_jump() const { return is_time && reading_only; }
  [[nodiscard]] double value(double x) const;
  /// The x of a value.
  [[nodiscard]] double x(double value) const;
};

}  // namespace driftwright::diagnosis
