#pragma once
// Where in an NC program a work offset may change: between which blocks, and how an axis then comes to its new place.

#include <vector>

#include "nc/step.hpp"

namespace driftwright {

/// How an axis takes a new offset that stands before a block. A change of offset moves nothing on its own, on LinuxCNC, Siemens and
/// Heidenhain alike: an axis follows when it is commanded next.
enum class NcEntry {
  kAlongRapid,      ///< the block is a rapid in G90 that names the axis: it arrives with the new offset
  kStepAfterRapid,  ///< a line of its own commands where the axis stands once more, by G0: the tool got there by G0
  kStepInFeed,      ///< the same by G1 at the feed in force: the tool is or has been cutting
  kNever,
};

/// Entry of each axis before the block `step`.
///
/// kNever: before, in and after a series of canned cycles until G80 or another motion word has ended it (its sticky levels), with
/// cutter compensation on (the contour looks ahead), before a block with '/' or with NcStep::no_place, and, where a line of its own would be wanted: while
/// the axis is not NcStep::known (after G28, G53, M6, G43, G54, '/' and the like until a G90 block names it again); where the next motion block has
/// no motion word and goes on with an arc; and in feed without a feed per minute in force.
/// @param step  < steps.size()
[[nodiscard]] std::array<NcEntry, 3> nc_entries(const std::vector<NcStep>& steps, std::size_t step);

/// nc_entries() of each block that takes time; of the others all kNever.
[[nodiscard]] std::vector<std::array<NcEntry, 3>> nc_entries(const std::vector<NcStep>& steps);

/// Why a block cannot be divided, or "" where it can: a straight G0 or G1 of N, G0, G1, X, Y, Z, F alone, in G90, with a feed per
/// minute or revolution, without cutter compensation, from a known place.
[[nodiscard]] std::string why_not_divisible(const NcStep& step);

}  // namespace driftwright
