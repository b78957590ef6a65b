#pragma once
// What a speed brings into a machine as heat, and which speeds a limit of that leaves to a warm-up.

#include "studies/warm_up_trials.hpp"

namespace driftwright::studies {

/// Heat of all sources at a speed, with no feed and no cutting, over that at rest [W]: friction of bearings, losses of the motor, gears, belts, in the
/// temperatures that the machine has when the warm-up begins. What a thermostat switches is left out.
[[nodiscard]] double heat_of_speed_W(const WarmUpTrials& trials, double speed_rpm);

/// The fastest speed, a whole multiple of kWarmUpStep_rpm, up to which none brings more heat than that.
/// @param most_rpm  not beyond it
/// @throws InputError  where the slowest brings more
[[nodiscard]] double fastest_within_rpm(const WarmUpTrials& trials, double most_rpm, double most_W);

}  // namespace driftwright::studies
