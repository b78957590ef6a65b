#pragma once
// A twin and its records as the catalogue sees them when it is asked what may be wrong.

#include "diagnosis/twin.hpp"
#include "effects/doubt.hpp"

namespace driftwright::diagnosis {

/// @param runs  may be empty: then nothing is stated at a speed of its own
[[nodiscard]] effects::DoubtScene scene_of(const Twin& twin, const std::vector<MeasuredRun>& runs);

/// The highest recorded speed, at least 1.
[[nodiscard]] double top_speed_rpm(const std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
