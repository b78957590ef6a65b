#pragma once
// Quantities with units, as they stand in files: "24 degC", "10 W/(m^2 K)", "80 mm".
// Units are parsed and converted by UDUNITS-2; this is one of the two places where conversion happens.

#include <string>

namespace driftwright {

/// Converts the text of a quantity, "<number> <unit>", to `unit`.
///
/// @param text  such as "80 mm"; the unit is compulsory unless `unit` is "1"
/// @param unit  the unit wanted, in UDUNITS syntax: "m", "W/(m^2 K)", "rpm", "1"
/// @throws RangeError  when the number or unit cannot be read, is not finite, has another dimension (an angle counts as
///                     one: Hz or 1/min is no rpm), or when a
///                     temperature with an offset (degC) is given where a temperature difference (K) is wanted
[[nodiscard]] double parse_quantity(const std::string& text, const std::string& unit);

/// Converts an absolute temperature, "24 degC" or "297.15 K", to kelvin.
/// @throws RangeError  as parse_quantity
[[nodiscard]] double parse_temperature_K(const std::string& text);

/// Factor that turns a value in `from` into a value in `to` (no offsets: for degC use parse_temperature_K).
/// @throws RangeError  when the dimensions differ
[[nodiscard]] double unit_factor(const std::string& from, const std::string& to);

inline constexpr double kZeroCelsius_K = 273.15;

}  // namespace driftwright
