#pragma once
// From the moves of an NC program to the sections of a cyclogram.

#include <vector>

#include "base/cyclogram.hpp"
#include "nc/motion.hpp"

namespace driftwright {

/// Merges moves shorter than `resolution_s` into sections of that length or a little more, within one spindle speed, and
/// leaves longer ones alone; changes of spindle speed stay where they are. A section's feed and cutting power are means:
///
///     feed = Σ travel / Σ duration,   power = cutting_power_W Σ duration of cutting moves / Σ duration
///
/// so that time, travel of each axis, turns of the spindle and cutting work are those of the moves. Neighbours with the same
/// drive become one section.
/// @param resolution_s     >= 0
/// @param cutting_power_W  power at the edge during every cutting move, >= 0
[[nodiscard]] std::vector<Cyclogram::Section> merged_sections(const std::vector<NcMove>& moves, double resolution_s,
                                                              double cutting_power_W);

/// The sections `times` over; neighbours with the same drive become one.
[[nodiscard]] std::vector<Cyclogram::Section> repeated(const std::vector<Cyclogram::Section>& sections, int times);

}  // namespace driftwright
