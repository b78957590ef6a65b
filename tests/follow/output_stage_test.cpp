// Hold, fade and slew, by closed forms.

#include "follow/output_stage.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftwright::follow::output_stage_test {
namespace {

constexpr OutputSettings kSettings{.most_rate_um_s = 2.0, .hold_s = 30.0, .fade_s = 100.0};

TEST(OutputStage, FollowsWhileRowsAreWell) {
  OutputStage stage(kSettings);
  EXPECT_EQ(stage.take(0.0, 0.0), 0.0);
  EXPECT_EQ(stage.take(7.5, 10.0), 7.5);
  EXPECT_EQ(stage.take(-3.25, 10.0), -3.25);
  EXPECT_EQ(stage.state().authority, 1.0);
}

TEST(OutputStage, NeverMovesFasterThanTheSlewLimit) {
  OutputStage stage(kSettings);
  EXPECT_EQ(stage.take(100.0, 0.0), 0.0);  // a start out of nothing takes its time, too
  EXPECT_EQ(stage.take(100.0, 10.0), 20.0);
  EXPECT_EQ(stage.take(-100.0, 5.0), 10.0);
}

TEST(OutputStage, KeepsTheLimitsOfTheMachine) {
  OutputStage stage({.most_rate_um_s = 2.0, .limits = {.most_um = 12.0, .most_step_um = 5.0}});
  (void)stage.take(0.0, 0.0);
  EXPECT_EQ(stage.take(100.0, 10.0), 5.0);
  EXPECT_EQ(stage.take(100.0, 1.0), 7.0);  // the slew limit is the narrower one
  EXPECT_EQ(stage.take(100.0, 10.0), 12.0);
  EXPECT_EQ(stage.take(100.0, 10.0), 12.0);
  for (int i = 0; i < 5; ++i) (void)stage.take(-100.0, 10.0);
  EXPECT_EQ(stage.state().correction_um, -12.0);
}

TEST(OutputStage, HoldsThenFadesAsAnExponential) {
  OutputStage stage({.most_rate_um_s = 10.0, .hold_s = 30.0, .fade_s = 100.0});
  (void)stage.take(50.0, 60.0);
  EXPECT_EQ(stage.wait(20.0), 50.0);
  EXPECT_EQ(stage.wait(10.0), 50.0);
  EXPECT_NEAR(stage.wait(40.0), 50.0 * std::exp(-0.4), 1e-12);
  EXPECT_NEAR(stage.wait(60.0), 50.0 * std::exp(-1.0), 1e-12);
  const double left = std::exp(-1.0);
  EXPECT_NEAR(stage.take(50.0, 100.0), 50.0 * (1.0 - (1.0 - left) * std::exp(-1.0)), 1e-12);  // and comes back the same way
}

TEST(OutputStage, FadesByTheAgeOfWhatDrivesTheMachine) {
  OutputStage stage({.most_rate_um_s = 10.0, .hold_s = 30.0, .fade_s = 100.0});
  (void)stage.take(50.0, 60.0);
  for (double age_s = 10.0; age_s < 55.0; age_s += 10.0) EXPECT_EQ(stage.take(60.0, 10.0, age_s), 60.0);
  ASSERT_EQ(stage.most_age_s(), 55.0);  // a hold and two and a half rows
  EXPECT_NEAR(stage.take(60.0, 10.0, 60.0), 60.0 * std::exp(-0.05), 1e-12);
  EXPECT_NEAR(stage.take(60.0, 10.0, 70.0), 60.0 * std::exp(-0.15), 1e-12);
  const double left = std::exp(-0.15);
  EXPECT_NEAR(stage.take(60.0, 10.0, 0.0), 60.0 * (1.0 - (1.0 - left) * std::exp(-0.1)), 1e-12);
}

TEST(OutputStage, OneLongWaitIsManyShortOnes) {
  OutputStage once({.most_rate_um_s = 10.0, .hold_s = 30.0, .fade_s = 100.0}), often = once;
  (void)once.take(50.0, 60.0);
  (void)often.take(50.0, 60.0);
  (void)once.wait(500.0);
  for (int i = 0; i < 500; ++i) (void)often.wait(1.0);
  EXPECT_NEAR(once.state().authority, std::exp(-4.7), 1e-15);
  EXPECT_NEAR(often.state().authority, once.state().authority, 1e-12);
  EXPECT_NEAR(often.state().correction_um, once.state().correction_um, 1e-9);
}

}  // namespace
}  // namespace driftwright::follow::output_stage_test
