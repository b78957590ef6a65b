#pragma once
// Converts the moves of an NC program into sections of a cyclogram.

#include <vector>

#include "base/cyclogram.hpp"
#include "nc/motion.hpp"

namespace driftwright {

/// Merges moves shorter than `resolution_s` into sections of that length or slightly longer, within one spindle speed, and
/// keeps longer ones; changes of spindle speed keep their times. A section's feed and cutting power are means:
///
///     feed = Σ travel / Σ duration,   power = cutting_power_W Σ duration of cutting moves / Σ duration
///
/// so that time, travel of each axis, turns of the spindle and cutting work equal those of the moves. Neighbours with the
/// same drive become one section.
/// @param resolution_s     >= 0
/// @param cutting_power_W  power at the edge during every cutting move, >= 0
[[nodiscard]] std::vector<Cyclogram::Section> merged_sections(const std::vector<NcMove>& moves, double resolution_s,
                                                              double cutting_power_W);

/// The sections `times` over; neighbours with the same drive become one.
[[nodiscard]] std::vector<Cyclogram::Section> repeated(const std::vector<Cyclogram::Section>& sections, int times);

}  // namespace driftwright
