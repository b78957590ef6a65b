#pragma once
// Units of a formula: found for each part from those of its names, so that a sum of watts and kelvins is refused.

#include <map>
#include <string>
#include <vector>

#include "base/quantity.hpp"
#include "effects/expression.hpp"

namespace driftwright::effects {

/// What the value of a part is. Values are in base units of the SI, temperatures in K, angles in rad, speeds of the spindle
/// as their number in rpm.
struct ValueUnit {
  std::map<std::string, double> powers = {};  ///< of base units, as BaseUnits has them; empty: a number
  /// A temperature with a zero, as 20 degC: two of them make a difference in K, which has none.
  bool is_temperature = false;
  bool fits_any = false;  ///< the number 0, which has any unit
};

/// The unit of a quantity in a formula, and the factor to its value there. `rpm` is the unit of numbers: W/rpm is W.
/// @throws RangeError  for an unknown unit
[[nodiscard]] BaseUnits units_in_formula(const std::string& unit);
/// True for a temperature with a zero (degC, degF), false for a difference (K) and all else.
[[nodiscard]] bool is_temperature(const std::string& unit);
[[nodiscard]] ValueUnit value_unit(const std::string& unit);

/// The unit in words: "W/K", "a temperature", "a number".
[[nodiscard]] std::string words(const ValueUnit& unit);

/// Checks the units of all parts and of the result.
/// @param of_name  units by name, in the order of the list of names that the expression was read with
/// @throws FormulaError  at the part that does not fit
void require_units(const Expression& expression, const std::vector<ValueUnit>& of_name, const ValueUnit& result);

}  // namespace driftwright::effects
