#pragma once
// A twin and its records in the form in which the catalogue lists its doubts.

#include "diagnosis/twin.hpp"
#include "effects/doubt.hpp"

namespace driftwright::diagnosis {

/// @param runs  may be empty; then no law has a speed of its own
[[nodiscard]] effects::DoubtScene scene_of(const Twin& twin, const std::vector<MeasuredRun>& runs);

/// The highest recorded speed, at least 1 rpm.
[[nodiscard]] double top_speed_rpm(const std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
