#pragma once
// What instruments of one card, or all of a machine, have in common: one reference junction, one supply, one way of being mounted.

#include "effects/doubt.hpp"

namespace driftwright::effects {

/// All instruments, and those whose names are alike up to the last `_`, `-`, `.` or `/` (card1_ch1, card1_ch2), each group once; none of one alone.
[[nodiscard]] std::vector<std::vector<std::string>> instrument_groups(const std::vector<std::string>& names);

/// A doubt of one instrument, for each group that it is in common to: the effect at each of them, its numbers the same.
/// @param doubt  with a single effect whose numbers are set by name
void add_in_groups(const std::vector<std::string>& names, const Doubt& doubt, std::vector<Doubt>& list);

}  // namespace driftwright::effects
