// The verdict on a strategy, by cases made by hand.

#include "compensation/judging/strategy_matrix.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace driftwright::compensation::strategy_matrix_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
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

compensation::Case with_failed(compensation::Case c, const std::string& failed) {
  c.failed = failed;
  return c;
}

// A verdict names its limits: how many cells keep the tolerance, and which do not, three of each sort.
TEST(StrategyMatrix, WithinLimitsNamesTheCellsThatKeepTheTolerance) {
  compensation::StrategyMatrix m = two_runs();
  for (compensation::JudgedRunOfMachine& run : m.runs) run.season = "summer";
  compensation::JudgedStrategy s;
  s.cases = {peaks(0, 40.0, 9.0), peaks(1, 40.0, 12.0)};
  for (const char* failed : {"t03 stuck", "t03 open", "t03 and t05 exchanged", "t05 stuck"})
    s.cases.push_back(with_failed(peaks(0, 40.0, 11.0), failed));
  s.cases.push_back(with_failed(peaks(1, 40.0, 13.0), "t03 stuck"));
  s.cases.push_back(with_failed(peaks(0, 40.0, 8.0), "t05 open"));
  compensation::give_verdict(m, s);
  EXPECT_EQ(s.safety, compensation::Safety::kWithinLimits);
  EXPECT_EQ(s.cells.n(), 8);
  EXPECT_EQ(s.cells.n_kept(), 2);
  EXPECT_EQ(s.cells.n_intact, 2);
  EXPECT_EQ(s.cells.n_kept_intact, 1);
  EXPECT_EQ(s.cells.n_not_kept, 5);
  EXPECT_THAT(s.cells.not_kept,
              ElementsAre("on 'large' (summer)", "with t03 stuck", "with t03 open", "with t03 and t05 exchanged"));
  EXPECT_THAT(s.why,
              HasSubstr("it keeps 10 µm in 2 of 8 cells (1 of 2 with all sensors intact): not on 'large' (summer), with "
                        "t03 stuck, with t03 open, with t03 and t05 exchanged and 1 other; "));
}

TEST(StrategyMatrix, CellsOfASafeStrategyAreAllKept) {
  const compensation::StrategyMatrix m = two_runs();
  compensation::JudgedStrategy s;
  s.cases = {peaks(0, 40.0, 9.0), peaks(1, 40.0, 10.0)};
  compensation::give_verdict(m, s);
  EXPECT_EQ(s.cells.n_kept(), 2);
  EXPECT_EQ(words_of(s.cells, 10.0), "keeps 10 µm in 2 of 2 cells");
}

}  // namespace
}  // namespace driftwright::compensation::strategy_matrix_test
