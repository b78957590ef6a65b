// One program for parts that agree, and what a plan leaves of another part's drift.

#include "compensation/schedule/program_series.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compensation/sensors/interpolate.hpp"
#include "nc/program.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::compensation::program_series_test {
namespace {

/// Ten passes of a minute, each with a rapid at which z may change.
NcProgram program() {
  std::string text = "G21 G90 G17 G54\nG0 X0 Z5\n";
  for (int i = 0; i < 10; ++i) text += "G0 Z1\nG1 Z0 F600\nG1 X10 F10\nG0 Z5\nG0 X0\n";
  NcSettings settings;
  settings.rapid_m_s = 0.1;
  return read_nc_program(write_file("program_series_test.ngc", text + "M30\n"), settings);
}

/// A drift that begins at `start_um` and grows by `growth_um` over the program.
std::vector<ProgramAxis> part_of(const std::vector<double>& time_s, double start_um, double growth_um) {
  std::vector<double> drift_um;
  for (double t_s : time_s) drift_um.push_back(start_um + growth_um * t_s / time_s.back());
  return {{.axis = 2, .sign = 1.0, .tolerance_um = 10.0, .drift_um = drift_um}};
}

std::vector<double> times_of(const NcProgram& p) {
  std::vector<double> time_s;
  for (int i = 0; i <= 100; ++i) time_s.push_back(p.duration_s() * i / 100.0);
  return time_s;
}

TEST(ProgramSeries, PartsThatAgreeWithinTheResolutionShareOnePlanAndOthersDoNot) {
  const NcProgram p = program();
  const std::vector<double> time_s = times_of(p);
  const auto plans = plan_series(p.steps, time_s,
                                 {part_of(time_s, 0, 30), part_of(time_s, 20, 15), part_of(time_s, 20.08, 15),
                                  part_of(time_s, 20.1, 15), part_of(time_s, 20.3, 15)},
                                 {});
  ASSERT_EQ(plans.size(), 3U);
  EXPECT_EQ(plans[0].first_part, 0);
  EXPECT_EQ(plans[0].last_part, 0);
  EXPECT_EQ(plans[1].first_part, 1);
  EXPECT_EQ(plans[1].last_part, 3);
  EXPECT_EQ(plans[2].first_part, 4);
  ASSERT_EQ(plans[1].courses.size(), 3U);
  EXPECT_NEAR(plans[1].courses[0][0].drift_um.front(), 20.0, 1e-9) << "each part with its own drift";
  EXPECT_NEAR(plans[1].courses[1][0].drift_um.front(), 20.08, 1e-9);
  EXPECT_NEAR(plans[1].peak_before_um(0), 35.1, 1e-9);
}

// What steals in by 0.08 um a part is compared with the part that the plan was made for, not with the neighbour.
TEST(ProgramSeries, ASlowCreepDoesNotHideInSmallSteps) {
  const NcProgram p = program();
  const std::vector<double> time_s = times_of(p);
  std::vector<std::vector<ProgramAxis>> parts;
  for (int i = 0; i < 9; ++i) parts.push_back(part_of(time_s, 0.08 * i, 30));
  const auto plans = plan_series(p.steps, time_s, parts, {});
  EXPECT_EQ(plans.size(), 5U);
  for (const SharedPlan& shared : plans) EXPECT_LE(shared.peak_after_um(0), 10.1 + 1e-9);
}

// A picture needs no more than its extremes.
TEST(ProgramSeries, AThinnedCourseKeepsItsEndsAndItsExtremes) {
  AxisCourse course;
  for (int i = 0; i < 10000; ++i) {
    course.time_s.push_back(i);
    course.drift_um.push_back(i == 4321 ? 99.0 : 1.0);
    course.correction_um.push_back(0.5);
    course.residual_um.push_back(i == 7777 ? -88.0 : course.drift_um.back() - 0.5);
  }
  course.peak_drift_um = 99.0;
  course.worst_um = 98.5;
  const AxisCourse thin = thinned(course, 500);
  EXPECT_LE(thin.time_s.size(), 500U);
  EXPECT_GE(thin.time_s.size(), 200U);
  EXPECT_TRUE(std::is_sorted(thin.time_s.begin(), thin.time_s.end()));
  EXPECT_EQ(thin.time_s.front(), 0.0);
  EXPECT_EQ(thin.time_s.back(), 9999.0);
  EXPECT_EQ(*std::max_element(thin.residual_um.begin(), thin.residual_um.end()), 98.5);
  EXPECT_EQ(*std::min_element(thin.residual_um.begin(), thin.residual_um.end()), -88.0);
  EXPECT_EQ(thin.worst_um, 98.5);
  EXPECT_EQ(thinned(course, 20000).time_s, course.time_s);
}

TEST(ProgramSeries, EveryAxisHasToAgree) {
  const NcProgram p = program();
  const std::vector<double> time_s = times_of(p);
  std::vector<ProgramAxis> first = part_of(time_s, 0, 30), second = first;
  first.push_back({.axis = 0, .sign = 1.0, .tolerance_um = 10.0, .drift_um = std::vector<double>(time_s.size(), 1.0)});
  second.push_back({.axis = 0, .sign = 1.0, .tolerance_um = 10.0, .drift_um = std::vector<double>(time_s.size(), 1.2)});
  EXPECT_EQ(plan_series(p.steps, time_s, {first, second}, {}).size(), 2U);
}

TEST(ProgramSeries, APlanLeavesOfItsOwnDriftWhatItWasMadeToLeave) {
  const NcProgram p = program();
  const std::vector<double> time_s = times_of(p);
  for (const SchedulePolicy policy : {SchedulePolicy::kMinimal, SchedulePolicy::kPaper}) {
    const auto axes = part_of(time_s, 0, 45);
    const ProgramSchedule plan = plan_program(p.steps, time_s, axes, {.policy = policy, .split = true});
    ASSERT_GT(plan.changes.size(), 0U);
    const AxisCourse again = courses_of(plan, p.steps, time_s, axes).front();
    EXPECT_EQ(again.time_s, plan.courses[0].time_s);
    EXPECT_EQ(again.residual_um, plan.courses[0].residual_um);
    EXPECT_EQ(again.worst_um, plan.courses[0].worst_um);
  }
}

// The correction is that of the plan; what is left is the other drift without it.
TEST(ProgramSeries, APlanLeavesOfAnotherDriftTheDifferenceAsWell) {
  const NcProgram p = program();
  const std::vector<double> time_s = times_of(p);
  const auto own = part_of(time_s, 0, 45), other = part_of(time_s, 3, 40);
  const ProgramSchedule plan = plan_program(p.steps, time_s, own, {});
  const AxisCourse course = courses_of(plan, p.steps, time_s, other).front();
  ASSERT_EQ(course.time_s, plan.courses[0].time_s);
  EXPECT_EQ(course.correction_um, plan.courses[0].correction_um);
  for (std::size_t i = 0; i < course.time_s.size(); ++i) {
    EXPECT_NEAR(course.drift_um[i], 3 + 40 * course.time_s[i] / time_s.back(), 1e-9);
    EXPECT_NEAR(course.residual_um[i], course.drift_um[i] - course.correction_um[i], 1e-12);
  }
  EXPECT_GT(course.worst_um, plan.courses[0].worst_um);
}

}  // namespace
}  // namespace driftwright::compensation::program_series_test
