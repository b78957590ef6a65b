#pragma once
// What the names in a logger's header mean, in English and German.

#include <cstddef>
#include <string>

namespace driftwright {

/// A header in its parts: "T3 (°C)" is T3 in degC.
struct HeaderWords {
  std::string name;
  std::string unit;  ///< as UDUNITS reads it; "": none is told
};
/// @param unit_line  what a line of units has below it; "" where there is none
[[nodiscard]] HeaderWords words_of_header(const std::string& header, const std::string& unit_line);

/// A unit as loggers write it, "°C", "U/min", "[mm]", "VDC", as UDUNITS reads it; "" for what is none.
[[nodiscard]] std::string unit_of_words(const std::string& text);
/// Of a name without unit: degC of a temperature, rpm of a speed, else 1.
[[nodiscard]] std::string likely_unit(const std::string& name);

[[nodiscard]] bool is_time_name(const std::string& name);
[[nodiscard]] bool is_tag_name(const std::string& name);
[[nodiscard]] bool is_value_name(const std::string& name);
/// Of the spindle's speed: "Drehzahl", "spindle speed"; not the speed of a feed, a fan or the wind.
[[nodiscard]] bool is_speed_name(const std::string& name);
/// Of a feed, a fan, a pump or the wind.
[[nodiscard]] bool turns_beside_spindle(const std::string& name);
/// The spindle alone, "Spindel" or "S1", which may be its speed, or its temperature or load.
[[nodiscard]] bool is_spindle_name(const std::string& name);
[[nodiscard]] bool is_ambient_name(const std::string& name);
/// Row numbers, alarms and the like, which are no readings.
[[nodiscard]] bool is_counter_name(const std::string& name);

/// As a channel may be called: lower case, umlauts written out, letters, digits and '_'; "channel_N" where nothing is left.
[[nodiscard]] std::string channel_name(const std::string& name, std::size_t number);

}  // namespace driftwright
