#pragma once
// A channel of a record: its place, and what kind of quantity it is.

#include <cstddef>
#include <string>

#include "base/record.hpp"

namespace driftwright {

/// Index of the channel of that name in record.channels. @throws InputError  as Record::at()
[[nodiscard]] inline std::size_t channel_index(const Record& record, const std::string& name) {
  return static_cast<std::size_t>(&record.at(name) - record.channels.data());
}

/// The channel of that name, to be changed. @throws InputError  as Record::at()
[[nodiscard]] inline Channel& changeable_channel(Record& record, const std::string& name) {
  return record.channels[channel_index(record, name)];
}

/// Whether a channel in that unit is a temperature, or a difference of temperatures.
[[nodiscard]] inline bool is_temperature_unit(const std::string& unit) {
  return unit == "degC" || unit == "K";
}

/// Whether it is a displacement or a tilt.
[[nodiscard]] inline bool is_displacement_unit(const std::string& unit) {
  return unit == "um" || unit == "mm" || unit == "urad";
}

}  // namespace driftwright
