#pragma once
// The numbers that a user knows only roughly: every uncertain number of the scenario as a knob with its prior.

#include "diagnosis/candidates.hpp"

namespace driftwright::diagnosis {

/// Numbers of effects, and conductivity, heat capacity and expansion of each region and node. The prior is that of the
/// scenario (`known_to`), otherwise that of the catalogue (10 %, exponents 3 %). Fixed numbers have no knob.
[[nodiscard]] std::vector<Knob> scatter(const Twin& twin);
/// The offset of each run's ambient from its record [K], with a standard deviation of 0.3 K.
[[nodiscard]] std::vector<Knob> ambient_scatter(const std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
