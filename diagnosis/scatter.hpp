#pragma once
// What a user knows only roughly: every uncertain number of the scenario as a knob with its prior.

#include "diagnosis/knob.hpp"
#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

/// Numbers of effects as their catalogue entries say (10 %, exponents 3 %), films by formula, conductivity, heat capacity and expansion of each
/// region and node.
[[nodiscard]] std::vector<Knob> scatter(const Twin& twin);

/// What an effect is called in a diagnosis: its place, or for a link both ends.
[[nodiscard]] std::string where_of(const effects::Effect& effect);

}  // namespace driftwright::diagnosis
