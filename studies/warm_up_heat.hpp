#pragma once
// The heat that a speed causes in a machine, and the speeds that a limit of it allows for a warm-up.

#include "studies/warm_up_trials.hpp"

namespace driftwright::studies {

/// Heat of all sources at a speed, without feed and cutting, minus that at rest [W]: friction of bearings, losses of
/// motor, gears and belts, at the machine's temperatures when the warm-up begins. Sources that a thermostat switches are
/// left out.
[[nodiscard]] double heat_of_speed_W(const WarmUpTrials& trials, double speed_rpm);

/// The fastest speed, a whole multiple of kWarmUpStep_rpm, up to which no speed causes more heat than the limit.
/// @param most_rpm  upper limit of the speed
/// @throws InputError  if the slowest speed causes more
[[nodiscard]] double fastest_within_rpm(const WarmUpTrials& trials, double most_rpm, double most_W);

}  // namespace driftwright::studies
