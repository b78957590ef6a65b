#include "studies/planner.hpp"

namespace driftwright::studies {

compensation::SchedulePolicy policy_of(const std::string& name) {
  return name == "paper" ? compensation::SchedulePolicy::kPaper : compensation::SchedulePolicy::kMinimal;
}

compensation::SchedulePolicy planner_of(const scenarios::Scenario& scenario) {
  return scenario.schedule ? policy_of(scenario.schedule->policy) : compensation::SchedulePolicy::kMinimal;
}

}  // namespace driftwright::studies
