#pragma once
// Numbers that instruments write where they have no reading: -273.15 and 850 degC of an open thermocouple, 888.8, 9999, -3276.8.

#include <string>
#include <vector>

#include "driftwright/record.hpp"

namespace driftwright {

/// Takes such numbers out of the temperatures, displacements and tilts of a record: they become missing. A stretch of readings equal to the last digit is taken out where
///  - it is -273.15 degC or colder;
///  - it is a temperature outside of the usual range (usual_ranges.hpp), or a difference as large, and more than 100 K off the readings before and after.
///    At an end of the record, where there is one of these alone, it must be three readings long;
///  - it is a displacement or tilt whose digits are a mark (999.9, 9999, 888.8, 3276.7, -3276.8, 32767, 65535 ...), off both by more than three times what all
///    other readings span;
///  - but a whole channel of one value that is usual when read in kelvin stays: it is refused by its unit.
/// A body that stays hot from row to row, such as a furnace, keeps its readings.
/// @returns  a sentence a channel: how many readings, which value, when
[[nodiscard]] std::vector<std::string> take_out_no_readings(Record& record);

}  // namespace driftwright
