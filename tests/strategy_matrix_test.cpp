// The verdict on a strategy, by cases made by hand.

#include "compensation/judging/strategy_matrix.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace driftwright::compensation::strategy_matrix_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

compensation::StrategyMatrix two_runs() {
  compensation::StrategyMatrix m;
  for (const char* name : {"small", "large"}) m.runs.push_back({.family = name, .season = "", .name = name, .run = {}});
  m.settings.tolerance_um = 10.0;
  return m;
}

compensation::Case peaks(std::size_t run, double before_um, double after_um) {
  compensation::Case c;
  c.run = run;
  c.before.peak_abs = before_um;
  c.before.rmse = before_um / 2.0;
  c.after.peak_abs = after_um;
  c.after.rmse = after_um / 2.0;
  return c;
}

TEST(StrategyMatrix, WhatMakesAStrategyUnsafeIsACaseBeyondTheTolerance) {
  const compensation::StrategyMatrix m = two_runs();
  compensation::JudgedStrategy s;
  s.cases = {peaks(0, 1.0, 9.0), peaks(1, 12.0, 14.0)};  // 8 um more inside the tolerance, 2 um more beyond it
  compensation::give_verdict(m, s);
  EXPECT_EQ(s.safety, compensation::Safety::kUnsafe);
  EXPECT_TRUE(s.is_worse_than_nothing);
  EXPECT_THAT(s.why, AllOf(HasSubstr("peak 14.0 instead of 12.0 µm on 'large'"), Not(HasSubstr("'small'"))));
}

TEST(StrategyMatrix, MoreThanNothingInsideTheToleranceIsSaidAndSafe) {
  const compensation::StrategyMatrix m = two_runs();
  compensation::JudgedStrategy s;
  s.cases = {peaks(0, 1.0, 9.0), peaks(1, 40.0, 8.0)};
  compensation::give_verdict(m, s);
  EXPECT_EQ(s.safety, compensation::Safety::kSafe);
  EXPECT_THAT(s.why, HasSubstr("peak 9.0 instead of 1.0 µm on 'small', inside the tolerance"));
}

}  // namespace
}  // namespace driftwright::compensation::strategy_matrix_test
