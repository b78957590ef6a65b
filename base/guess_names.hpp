#pragma once
// The meaning of names in a logger's header, in English and German.

#include <cstddef>
#include <string>

namespace driftwright {

/// A header split into name and unit: "T3 (°C)" is T3 in degC.
struct HeaderWords {
  std::string name;
  std::string unit;  ///< as UDUNITS reads it; "": not given
};
/// @param unit_line  the cell below it in a line of units; "" without such a line
[[nodiscard]] HeaderWords words_of_header(const std::string& header, const std::string& unit_line);

/// A unit as loggers write it, "°C", "U/min", "[mm]", "VDC", in UDUNITS syntax; "" if the text is not a unit.
[[nodiscard]] std::string unit_of_words(const std::string& text);
/// The likely unit of a name without unit: degC of a temperature, rpm of a speed, else 1.
[[nodiscard]] std::string likely_unit(const std::string& name);

[[nodiscard]] bool is_time_name(const std::string& name);
[[nodiscard]] bool is_tag_name(const std::string& name);
[[nodiscard]] bool is_value_name(const std::string& name);
/// A name of the spindle's speed: "Drehzahl", "spindle speed"; not the speed of a feed, a fan or the wind.
[[nodiscard]] bool is_speed_name(const std::string& name);
/// A name of a feed, a fan, a pump or the wind.
[[nodiscard]] bool turns_beside_spindle(const std::string& name);
/// A name of the spindle alone, "Spindel" or "S1": the column may be its speed, temperature or load.
[[nodiscard]] bool is_spindle_name(const std::string& name);
[[nodiscard]] bool is_ambient_name(const std::string& name);
/// A name of row numbers, alarms and the like, which are no readings.
[[nodiscard]] bool is_counter_name(const std::string& name);

/// A valid channel name: lower case, umlauts written out, letters, digits and '_'; "channel_N" where nothing remains.
[[nodiscard]] std::string channel_name(const std::string& name, std::size_t number);

}  // namespace driftwright
