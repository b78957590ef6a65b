#pragma once
// What machines usually have, in one table: what lies outside is warned of, and refused with `--strict`.

#include <optional>
#include <string>
#include <vector>

namespace driftwright {

enum class Usual {
  kHeat,
  kFilm,
  kContact,
  kLink,
  kCapacity,
  kFeed,
  kAmbient,
  kTemperature,
  kDrift,
  kTilt,
  kSensitivity,
  kDensity,
  kConductivity,
  kHeatCapacity,
  kYoungsModulus,
  kExpansion,
  kRowInterval,
};

/// A range in the unit that people use, which is `unit_SI` times as large as that of the program (temperatures: degC, from K).
struct UsualRange {
  Usual of = Usual::kHeat;
  const char* what = "";         ///< "heat of one source or cooler"
  const char* unit = "";         ///< as it is shown
  double unit_SI = 1.0;          ///< the unit in SI: 1000 for kW
  double low = 0.0, high = 0.0;  ///< in `unit`, both usual
  const char* source = "";
};

/// All of them, in the order of Usual.
[[nodiscard]] const std::vector<UsualRange>& usual_ranges();
[[nodiscard]] const UsualRange& usual_range(Usual of);

/// What is said of a value outside of its range: "150 kW at 6000 rpm; usual is -30 to 30 kW"; nothing for a usual one. NaN is outside of every range.
/// @param value  in SI; temperatures in degC
/// @param when   " at 6000 rpm", written after the value
[[nodiscard]] std::optional<std::string> beyond_usual(Usual of, double value, const std::string& when = "");

}  // namespace driftwright
