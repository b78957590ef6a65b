#pragma once
// The longest time that a record may cover.

#include <string>

namespace driftwright {

/// 100 years [s].
inline constexpr double kLongestRecord_s = 100.0 * 365.25 * 86400.0;

/// @param path     of the record, for the message
/// @param first_s  time of its first row
/// @param last_s   of its last
/// @throws InputError  for more than kLongestRecord_s: no machine is recorded for so long, and its simulation would not end
void require_possible_span(const std::string& path, double first_s, double last_s);

}  // namespace driftwright
