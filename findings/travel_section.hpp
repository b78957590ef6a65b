#pragma once
// What corrections leave along the travel of an axis, as part of a document.

#include "output/document.hpp"
#include "studies/validation_study.hpp"

namespace driftwright::findings {

/// Section `travel`: what corrections for several places leave anywhere on the travel, against none and against a correction
/// for one place used everywhere; the largest error over the position as a picture; the commands that write files for
/// controls.
/// @param made_by  names the folder of results in these commands
[[nodiscard]] output::Section travel_section(const studies::JudgedTravel& judged, const output::Provenance& made_by);

}  // namespace driftwright::findings
