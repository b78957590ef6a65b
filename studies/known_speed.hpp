#pragma once
// The speeds that a scenario says something of.

#include "scenarios/reader/scenario.hpp"

namespace driftwright::studies {

/// The highest speed [rpm] that the scenario knows: of its cyclograms, or at which a law states its heat or growth; 0:
/// none.
[[nodiscard]] double known_speed_rpm(const scenarios::Scenario& scenario);

}  // namespace driftwright::studies
