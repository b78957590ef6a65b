#pragma once
// Units of records and reports for outputs of the computation, which are in K, m and rad.

#include <string_view>

namespace driftwright {

/// "um" for m, "urad" for rad, "K" for K: the unit of a difference, an error or a noise.
[[nodiscard]] constexpr const char* shown_difference_unit(std::string_view si_unit) {
  return si_unit == "K" ? "K" : si_unit == "m" ? "um" : "urad";
}

/// The same for a reading: a temperature is in degC, and its zero differs too.
[[nodiscard]] constexpr const char* shown_reading_unit(std::string_view si_unit) {
  return si_unit == "K" ? "degC" : shown_difference_unit(si_unit);
}

/// Factor from the unit of the computation to either of them.
[[nodiscard]] constexpr double shown_scale(std::string_view si_unit) {
  return si_unit == "K" ? 1.0 : 1e6;
}

}  // namespace driftwright
