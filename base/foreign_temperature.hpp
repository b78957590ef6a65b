#pragma once
// Detects temperatures whose header names the wrong unit: degF or kelvin under degC.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/quantity.hpp"

namespace driftwright {

/// Another temperature scale; a reading in it is (reading - zero) / per_K in degC.
struct TemperatureScale {
  const char* unit;
  double zero, per_K;
};
inline constexpr std::array<TemperatureScale, 2> kForeignScales = {{{"degF", 32.0, 1.8}, {"kelvin", kZeroCelsius_K, 1.0}}};

inline constexpr double kFarBeside_K = 25.0;  ///< of a record's median; machines and models never differ as much
inline constexpr double kFarBetter = 5.0;     ///< ratio of the distances before and after the conversion

/// The unit that temperatures under a degC header probably have, or none. It is degF or kelvin when the median is more than
/// kFarBeside_K outside of low_C..high_C, and converted from that unit lies at most 1/kFarBetter as far outside.
/// @param readings  in the header's degC, NaN where missing  @param low_C, high_C  expected range
[[nodiscard]] std::optional<std::string> foreign_temperature(const std::vector<double>& readings, double low_C,
                                                             double high_C);

}  // namespace driftwright
