#pragma once
// A body at ambient temperature that comes to another one, and may leave again: a pallet, a workpiece, a cup of water.
// Its heat uptake looks like a window of heat that fades.

#include <optional>

#include "diagnosis/happening.hpp"

namespace driftwright::diagnosis {

/// The possible visits of a happening: a body that comes at the begin of its first window and stays until the record
/// ends, and one that leaves again, each with its capacity and its time constant.
/// @returns  none if it is neither heat in a body nor an exchange of one with the ambient, if it repeats, or if it has
/// windows in several runs
[[nodiscard]] std::vector<Event> visits_of(const effects::DoubtScene& scene, const Happening& happening);

}  // namespace driftwright::diagnosis
