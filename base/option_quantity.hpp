#pragma once
// Quantities on the command line.

#include <string>

namespace driftwright {

/// The number in an option's text, in `unit`. @throws InputError  with the option, its text and what is wrong with it
[[nodiscard]] double option_quantity(const std::string& option, const std::string& text, const std::string& unit);
/// The same between two bounds in that unit. @throws InputError  also outside them, NaN included; bounds of the unit "1" are
/// written in %
[[nodiscard]] double option_quantity(const std::string& option, const std::string& text, const std::string& unit,
                                     double least, double most);

}  // namespace driftwright
