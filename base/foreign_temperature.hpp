#pragma once
// Numbers that are right and a header that is not: degF or kelvin under degC.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/quantity.hpp"

namespace driftwright {

/// Readings of another scale, and what they are in degC: (reading - zero) / per_K.
struct TemperatureScale {
  const char* unit;
  double zero, per_K;
};
inline constexpr std::array<TemperatureScale, 2> kForeignScales = {{{"degF", 32.0, 1.8}, {"kelvin", kZeroCelsius_K, 1.0}}};

inline constexpr double kFarBeside_K = 25.0;  ///< over a whole record: no machine, and no model of one, is so far off
inline constexpr double kFarBetter = 5.0;     ///< is what is left after the conversion

/// Unit that temperatures under a degC header look like, or none: as they are their median lies more than kFarBeside_K beside what is
/// known of them, read as degF or kelvin at most 1/kFarBetter as far.
/// @param readings  in the header's degC, NaN where missing  @param low_C, high_C  where they should lie
[[nodiscard]] std::optional<std::string> foreign_temperature(const std::vector<double>& readings, double low_C,
                                                             double high_C);

}  // namespace driftwright
