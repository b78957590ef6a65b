#pragma once
// Quantities with units, as in files: "24 degC", "10 W/(m^2 K)", "80 mm".
// Units are parsed and converted by UDUNITS-2; this is one of the two places where conversion happens. All functions are
// thread-safe.

#include <map>
#include <string>

namespace driftwright {

/// Converts the text of a quantity, "<number> <unit>", to `unit`.
///
/// @param text  such as "80 mm"; the unit is compulsory unless `unit` is "1"
/// @param unit  the required unit, in UDUNITS syntax: "m", "W/(m^2 K)", "rpm", "1"
/// @throws RangeError  when the number or unit cannot be read, is not finite, has another dimension (an angle counts as
///                     one: Hz or 1/min is no rpm), or when a
///                     temperature with an offset (degC) is given where a temperature difference (K) is required
[[nodiscard]] double parse_quantity(const std::string& text, const std::string& unit);

/// Converts an absolute temperature, "24 degC" or "297.15 K", to kelvin.
/// @throws RangeError  as parse_quantity
[[nodiscard]] double parse_temperature_K(const std::string& text);

/// Factor that turns a value in `from` into a value in `to` (no offsets: for degC use parse_temperature_K).
/// @throws RangeError  when the dimensions differ
[[nodiscard]] double unit_factor(const std::string& from, const std::string& to);

/// A unit as a factor times powers of base units.
struct BaseUnits {
  double factor = 1.0;                        ///< a value in the unit times this is in base units, without an offset
  std::map<std::string, double> powers = {};  ///< by symbol: m, kg, s, K, A, mol, cd; an angle counts as a number [rad]
  bool operator==(const BaseUnits&) const = default;
};
/// @param unit  in UDUNITS syntax; "" means "1"
/// @throws RangeError  when it is unknown, or logarithmic or a date
[[nodiscard]] BaseUnits in_base_units(const std::string& unit);

/// A quantity as written in a file.
struct Quantity {
  double number = 0.0;
  std::string unit;  ///< as written; empty without a unit
};

/// The parts of "80 mm". @throws RangeError  when it does not begin with a finite number, or its unit is unknown
[[nodiscard]] Quantity split_quantity(const std::string& text);

/// A number in `from` as a number in `to`. Temperatures are absolute; "" means "1".
/// @throws RangeError  when the dimensions differ
[[nodiscard]] double convert(double number, const std::string& from, const std::string& to);

/// True for units of temperature whose zero is not that of the kelvin scale.
[[nodiscard]] bool has_offset(const std::string& unit);

/// A unit in the form used in names: "W/(m^2 K)" gives "W_m2K", "" gives "1".
[[nodiscard]] std::string unit_in_name(const std::string& unit);

inline constexpr double kZeroCelsius_K = 273.15;

}  // namespace driftwright
