#pragma once
// How long a record may be.

#include <string>

namespace driftwright {

inline constexpr double kLongestRecord_s = 100.0 * 365.25 * 86400.0;

/// @param path     of the record, for the message
/// @param first_s  time of its first row
/// @param last_s   of its last
/// @throws InputError  for more than a hundred years: no machine is recorded for so long, and simulating it would not end
void require_possible_span(const std::string& path, double first_s, double last_s);

}  // namespace driftwright
