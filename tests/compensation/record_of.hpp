#pragma once
// Records of given channels, and messages, for tests of what is fitted to records.

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.hpp"
#include "base/record.hpp"

namespace driftwright::fixtures {

/// One row a second.
inline Record record_of(std::vector<Channel> channels) {
  Record record{.source = "test", .time_s = {}, .channels = std::move(channels)};
  for (std::size_t i = 0; i < record.channels[0].values.size(); ++i) record.time_s.push_back(static_cast<double>(i));
  return record;
}

/// The message of the InputError that it throws.
inline std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& e) {
    return e.what();
  }
  return "no InputError";
}

}  // namespace driftwright::fixtures
