#pragma once
// What a user knows only roughly: every uncertain number of the scenario as a knob with its prior.

#include "diagnosis/candidates.hpp"

namespace driftwright::diagnosis {

/// Numbers of effects, and conductivity, heat capacity and expansion of each region and node: known to what the scenario says (`known_to`), else to what their
/// catalogue entries say (10 %, exponents 3 %). What is fixed is no knob.
[[nodiscard]] std::vector<Knob> scatter(const Twin& twin);
/// How far the ambient of each run was from what was recorded: an offset [K] a run, 0.3 K of standard deviation.
[[nodiscard]] std::vector<Knob> ambient_scatter(const std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
