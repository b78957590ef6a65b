#pragma once
// Which policy plans corrections: the one that `schedule` writes programs by is the one that `run`, `validate` and `compensate` judge.

#include <string>

#include "compensation/schedule/schedule_policy.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::studies {

/// @param name  one of scenarios::kSchedulePolicies
[[nodiscard]] compensation::SchedulePolicy policy_of(const std::string& name);

/// The policy of the scenario's block `schedule`; `minimal`, its default, where there is none.
[[nodiscard]] compensation::SchedulePolicy planner_of(const scenarios::Scenario& scenario);

}  // namespace driftwright::studies
