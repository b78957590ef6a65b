// The policy of the block `schedule` is the one that judged plans are made by.

#include "studies/planner.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "compensation/judging/correction.hpp"

namespace driftwright::studies::planner_test {
namespace {

using compensation::SchedulePolicy;

TEST(Planner, ThePolicyOfTheScenarioPlans) {
  scenarios::Scenario scenario;
  EXPECT_EQ(studies::planner_of(scenario), SchedulePolicy::kMinimal);
  scenario.schedule.emplace();
  scenario.schedule->policy = "minimal";
  EXPECT_EQ(studies::planner_of(scenario), SchedulePolicy::kMinimal);
  scenario.schedule->policy = "paper";
  ASSERT_EQ(studies::planner_of(scenario), SchedulePolicy::kPaper);

  // a drift of 0 to 45 um and a tolerance of 10 um: `paper` corrects by whole tolerances, `minimal` by as much as it needs
  std::vector<double> time_s, drift_um;
  for (int i = 0; i <= 90; ++i) {
    time_s.push_back(60.0 * i);
    drift_um.push_back(0.5 * i);
  }
  const std::vector<double> boundaries_s = {0.0, 5400.0};
  const compensation::CorrectedDrift paper = compensation::correct_by_schedule({time_s, drift_um, boundaries_s, 10.0},
                                                                               drift_um, 0.0, studies::planner_of(scenario));
  ASSERT_TRUE(paper.schedule);
  double corrected_um = 0.0;
  for (const compensation::Correction& c : paper.schedule->operations.front().corrections) {
    EXPECT_NEAR(std::remainder(c.delta_um, 10.0), 0.0, 1e-9);
    corrected_um += c.delta_um;
  }
  EXPECT_NEAR(corrected_um, 40.0, 1e-9);
}

}  // namespace
}  // namespace driftwright::studies::planner_test
