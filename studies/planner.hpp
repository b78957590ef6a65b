#pragma once
// The policy that plans corrections: `run`, `validate` and `compensate` judge the same one that `schedule` writes
// programs with.

#include <string>

#include "compensation/schedule/schedule_policy.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::studies {

/// @param name  one of scenarios::kSchedulePolicies
[[nodiscard]] compensation::SchedulePolicy policy_of(const std::string& name);

/// The policy of the scenario's block `schedule`; without the block its default, `minimal`.
[[nodiscard]] compensation::SchedulePolicy planner_of(const scenarios::Scenario& scenario);

}  // namespace driftwright::studies
