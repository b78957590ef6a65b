#pragma once
// Where a channel is in its record.

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

}  // namespace driftwright
