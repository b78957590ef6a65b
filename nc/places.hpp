#pragma once
// The places in an NC program where a work offset may change: between which blocks, and how an axis then moves to its new
// position.

#include <vector>

#include "nc/step.hpp"

namespace driftwright {

/// How an axis moves after an offset change before a block. A change of offset moves nothing, on LinuxCNC, Siemens and
/// Heidenhain alike: an axis follows with its next commanded move.
enum class NcEntry {
  kAlongRapid,      ///< the block is a rapid in G90 that names the axis: this rapid includes the new offset
  kStepAfterRapid,  ///< an inserted G0 line commands the present position once more: the tool got there by G0
  kStepInFeed,      ///< the same by G1 at the feed in force: the tool is or has been cutting
  kNever,           ///< no change is possible here
};

/// Entry of each axis before the block `step`.
///
/// kNever applies: before, in and after a series of canned cycles until G80 or another motion word has ended it (its sticky
/// levels); with cutter compensation on (the contour looks ahead); before a block with '/' or with NcStep::no_place. Where
/// an inserted line would be needed, it also applies: while the axis is not NcStep::known (after G28, G53, M6, G43, G54, '/'
/// and the like until a G90 block names it again); if the next motion block has no motion word and continues with an arc;
/// and in feed without a feed per minute in force.
/// @param step  < steps.size()
[[nodiscard]] std::array<NcEntry, 3> nc_entries(const std::vector<NcStep>& steps, std::size_t step);

/// nc_entries() of each block that takes time; kNever for the others.
[[nodiscard]] std::vector<std::array<NcEntry, 3>> nc_entries(const std::vector<NcStep>& steps);

/// Why a block cannot be divided, or "" if it can: a straight G0 or G1 with only N, G0, G1, X, Y, Z, F, in G90, with a feed
/// per minute or revolution, without cutter compensation, from a known position.
[[nodiscard]] std::string why_not_divisible(const NcStep& step);

}  // namespace driftwright
