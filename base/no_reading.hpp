#pragma once
// Finds numbers that instruments write when they have no reading: -273.15 and 850 degC of an open thermocouple, 888.8, 9999,
// -3276.8.

#include <string>
#include <vector>

#include "driftwright/record.hpp"

namespace driftwright {

/// Removes such numbers from the temperatures, displacements and tilts of a record: they become missing. A stretch of
/// exactly equal readings is removed where
///  - it is -273.15 degC or colder;
///  - it is a temperature outside of the usual range (usual_ranges.hpp), or an equally large difference, and more than 100 K
///    away from the readings before and after. At an end of the record, where only one of these exists, the stretch must be
///    at least three readings long;
///  - it is a displacement or tilt whose digits are a known mark (999.9, 9999, 888.8, 3276.7, -3276.8, 32767, 65535 ...),
///    and its distance from both neighbours is more than three times the span of all other readings;
///  - but a whole channel of one value that is usual when read in kelvin is kept: it is refused later because of its unit.
/// A body that stays hot from row to row, such as a furnace, keeps its readings.
/// @returns  one sentence per channel: how many readings, which value, when
[[nodiscard]] std::vector<std::string> take_out_no_readings(Record& record);

}  // namespace driftwright
