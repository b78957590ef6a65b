#include "compensation/judging/correction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace driftwright::compensation::correction_test {
namespace {

using ::testing::DoubleNear;
using ::testing::Pointwise;

const std::vector<double> kTime_s = {0, 60, 120, 180};
const std::vector<double> kDrift_um = {0, 4, 8, 12};
const std::vector<double> kBoundaries_s = {0, 120, 180};

DriftToCorrect run_with_tolerance(double tolerance_um) {
  return {kTime_s, kDrift_um, kBoundaries_s, tolerance_um};
}

TEST(CorrectByInjector, CountsTheMomentBeforeEachUpdateToo) {
  // A perfect prediction leaves 0 just after each sample, and the 4 um of a step just before the next one.
  const CorrectedDrift c = correct_by_injector(run_with_tolerance(4.0), kDrift_um, 1.0);
  EXPECT_EQ(c.residual_um, (std::vector<double>{0, 4, 4, 4}));
  EXPECT_DOUBLE_EQ(c.before.peak_abs, 12.0);
  EXPECT_DOUBLE_EQ(c.after.peak_abs, 4.0);
  EXPECT_TRUE(c.inside_tolerance);
  EXPECT_FALSE(correct_by_injector(run_with_tolerance(3.9), kDrift_um, 1.0).inside_tolerance);
}

TEST(CorrectByInjector, AWrongPredictionLeavesItsError) {
  const std::vector<double> half_um = {0, 2, 4, 6};
  EXPECT_EQ(correct_by_injector(run_with_tolerance(10.0), half_um, 1.0).residual_um,
            (std::vector<double>{0, 4, 6, 8}));  // d - c, c one step late
}

TEST(CorrectBySchedule, StepsBeforeThePredictionLeavesTheTolerance) {
  // 4 um/min, tolerance 5 um: nothing until the prediction passes 5 um at 75 s, from there the middle of 12 - 5 and 5 + 5
  // um. The second operation starts at 120 s.
  const CorrectedDrift c = correct_by_schedule(run_with_tolerance(5.0), kDrift_um, 0.0);
  ASSERT_TRUE(c.schedule.has_value());
  EXPECT_EQ(to_text(*c.schedule), "2-{1.25,0.75}-{0,8.5}\n1-{1}-{0}\n");
  EXPECT_THAT(c.residual_um, Pointwise(DoubleNear(1e-9), {0.0, 4.0, -0.5, 3.5}));
  EXPECT_TRUE(c.inside_tolerance);
  // the paper's steps: 5 um where the prediction passes 5 and 10 um, at 75 s and 150 s
  const CorrectedDrift paper = correct_by_schedule(run_with_tolerance(5.0), kDrift_um, 0.0, SchedulePolicy::kPaper);
  EXPECT_EQ(to_text(*paper.schedule), "2-{1.25,0.75}-{0,5}\n2-{0.5,0.5}-{0,5}\n");
  EXPECT_EQ(paper.residual_um, (std::vector<double>{0, 4, 3, 2}));
}

TEST(CorrectBySchedule, AMarginBeyondHalfTheToleranceIsCutToIt) {
  const CorrectedDrift cut = correct_by_schedule(run_with_tolerance(5.0), kDrift_um, 100.0);
  const CorrectedDrift half = correct_by_schedule(run_with_tolerance(5.0), kDrift_um, 2.5);
  EXPECT_EQ(cut.residual_um, half.residual_um);
}

TEST(Judging, AMissingSampleIsNotInside) {
  std::vector<double> drift_um = kDrift_um;
  drift_um[2] = std::numeric_limits<double>::quiet_NaN();
  const DriftToCorrect run{kTime_s, drift_um, kBoundaries_s, 100.0};
  EXPECT_FALSE(correct_by_injector(run, kDrift_um, 1.0).inside_tolerance);
}

TEST(OperationBoundaries, AddUp) {
  EXPECT_EQ(operation_boundaries_s(std::vector<double>{60, 30, 10}), (std::vector<double>{0, 60, 90, 100}));
}

}  // namespace
}  // namespace driftwright::compensation::correction_test
