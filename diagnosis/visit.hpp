#pragma once
// A body as warm as the ambient that comes to another one, and may go again: a pallet, a workpiece, a cup of water. What its coming takes up looks like a window of
// heat that fades.

#include <optional>

#include "diagnosis/happening.hpp"

namespace driftwright::diagnosis {

/// The visits that a happening may be: a body that comes when its first window begins and stays until the record ends, and one that goes again, each by its capacity
/// and by how fast it follows.
/// @returns  none where it is no heat in a body and no exchange of one with the ambient, where it repeats, or has windows in several runs
[[nodiscard]] std::vector<Event> visits_of(const effects::DoubtScene& scene, const Happening& happening);

}  // namespace driftwright::diagnosis
