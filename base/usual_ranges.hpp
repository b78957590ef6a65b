#pragma once
// The usual ranges of machine data, in one table. A value outside gives a warning, and an error with `--strict`.

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

/// A range in the unit that people use. `unit_SI` is this unit in the program's unit (temperatures are in degC).
struct UsualRange {
  Usual of = Usual::kHeat;
  const char* what = "";         ///< "heat of one source or cooler"
  const char* unit = "";         ///< as shown
  double unit_SI = 1.0;          ///< the unit in SI: 1000 for kW
  double low = 0.0, high = 0.0;  ///< in `unit`; both ends count as usual
  const char* source = "";
};

/// All of them, in the order of Usual.
[[nodiscard]] const std::vector<UsualRange>& usual_ranges();
[[nodiscard]] const UsualRange& usual_range(Usual of);

/// The text for a value outside of its range: "150 kW at 6000 rpm; usual is -30 to 30 kW"; none for a usual value. NaN is
/// outside of every range.
/// @param value  in SI; temperatures in degC
/// @param when   " at 6000 rpm", written after the value
[[nodiscard]] std::optional<std::string> beyond_usual(Usual of, double value, const std::string& when = "");

}  // namespace driftwright
