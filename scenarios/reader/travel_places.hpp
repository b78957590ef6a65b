#pragma once
// The places along the travel of a feed axis whose errors one entry of `displacements` reads.

#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {

/// Adds to a displacement what an effect `feed_axis` says of the error at its place. @throws RangeError  outside the travel
void read_axis_error(MachineModel& model, const effects::Effect& feed_axis, DisplacementOutput& displacement);

/// The displacements of the entry that one of them belongs to, by rising position; empty if it has no position of a screw,
/// or if it is the only one.
[[nodiscard]] std::vector<DisplacementOutput> places_along(const MachineModel& model, const std::string& displacement);

/// Adds a displacement half-way between each two of these places, named as they are: what is judged where nothing is
/// corrected.
/// A name that exists already is passed over.
void add_places_between(MachineModel& model, const std::string& displacement);

}  // namespace driftwright::scenarios
