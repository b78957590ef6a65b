#pragma once
// Groups of instruments that share something: a reference junction, a supply, a way of mounting.

#include "effects/doubt.hpp"

namespace driftwright::effects {

/// All instruments, and those whose names are equal up to the last `_`, `-`, `.` or `/` (card1_ch1, card1_ch2). Each group
/// appears once and has at least two members.
[[nodiscard]] std::vector<std::vector<std::string>> instrument_groups(const std::vector<std::string>& names);

/// Adds a doubt of one instrument for each group of instruments: the effect at each member, with common numbers.
/// @param doubt  with a single effect whose numbers are set by name
void add_in_groups(const std::vector<std::string>& names, const Doubt& doubt, std::vector<Doubt>& list);

}  // namespace driftwright::effects
