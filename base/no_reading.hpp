#pragma once
// Numbers that instruments write where they have no reading: -273.15 and 850 degC of an open thermocouple, 888.8, 9999, -3276.8.

#include <string>
#include <vector>

#include "driftwright/record.hpp"

namespace driftwright {

/// Makes readings of temperatures, displacements and tilts missing that are none. A stretch of readings equal to the last digit is none where
///  - it is -273.15 degC or colder;
///  - it is a temperature outside of the usual range (usual_ranges.hpp), or a difference as large, and more than 100 K off the readings before and after.
///    At an end of the record, where there is one of these alone, it must be three readings long;
///  - it is a displacement or tilt whose digits are a mark (999.9, 9999, 888.8, 3276.7, -3276.8, 32767, 65535 ...), off both by more than three times what all
///    other readings span.
/// A body that is hot from row to row, such as a furnace, is none of these.
/// @returns  a sentence a channel: how many readings, which value, when
[[nodiscard]] std::vector<std::string> take_out_no_readings(Record& record);

}  // namespace driftwright
