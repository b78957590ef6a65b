// The verdict on a strategy, by cases made by hand.

#include "compensation/judging/strategy_matrix.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "compensation/judging/failed_left_out.hpp"
#include "compensation/judging/strategy_verdict.hpp"
#include "compensation/predictors/formula_predictor.hpp"

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

/// Two runs, or one: a bed that warms by 40 K in 400 min, and a drift of 1 um/K.
FoldedRuns warming(int n_runs) {
  std::vector<MachineRun> runs;
  for (int r = 0; r < n_runs; ++r) {
    MachineRun run{
        .cyclogram = {}, .ambient = {}, .readings = {.source = r == 0 ? "one" : "two", .time_s = {}, .channels = {}}};
    run.readings.channels = {{"bed", "degC", {}}, {"tip_z", "um", {}}};
    for (int i = 0; i <= 400; ++i) {
      run.readings.time_s.push_back(60.0 * i);
      run.readings.channels[0].values.push_back(20.0 + 0.1 * i);
      run.readings.channels[1].values.push_back(0.1 * i);
    }
    runs.push_back(std::move(run));
  }
  return folded(runs, {.target = "tip_z", .from_start = false, .thermometers = {"bed"}, .speed = ""});
}

/// A drift of `slope_um_K` times the rise of the bed above 20 degC, whatever it was fitted to.
DeployedPredictor sloping(double slope_um_K) {
  DeployedPredictor d;
  d.target = "tip_z";
  d.sensors = {"bed"};
  d.predictor =
      std::make_shared<FormulaPredictor>(DriftModel{.kind = "line",
                                                    .target = "tip_z",
                                                    .target_unit = "um",
                                                    .intercept = -20.0 * slope_um_K,
                                                    .terms = {{.input = "bed", .unit = "degC", .coefficient = slope_um_K}}});
  return d;
}

MatrixSettings failing() {
  MatrixSettings s;
  s.strategies.target = "tip_z";
  s.strategies.candidates = {"bed"};
  s.fails_at = 0.5;
  return s;
}

// A model that was fitted to the run itself would leave 40 um at most, of an open thermometer.
TEST(FailedSensors, AreTriedOnRunsThatTheModelWasNotFittedTo) {
  const FoldedRuns folds = warming(2);
  std::vector<FittedInFold> in_folds;
  for (std::size_t k : folds_for_failures(folds)) in_folds.push_back({k, sloping(folds.folds[k].name == "one" ? 3.0 : 1.5)});
  ASSERT_EQ(in_folds.size(), 2u);
  // drifting up by 2 K/h over the second half of 400 min, on the run that the model with 3 um/K did not see
  EXPECT_NEAR(failed_left_out_um(failing(), folds, in_folds).value(), 3.0 * (40.0 + 2.0 * 200.0 / 60.0) - 40.0, 1e-6);
}

TEST(FailedSensors, OfASingleRunAreTriedOnItsLastThird) {
  const FoldedRuns folds = warming(1);
  const std::vector<std::size_t> tried = folds_for_failures(folds);
  ASSERT_EQ(tried.size(), 1u);
  EXPECT_EQ(folds.folds[tried.front()].kind, "end");
  const std::vector<FittedInFold> in_folds = {{tried.front(), sloping(3.0)}};
  const std::vector<bool>& hidden = folds.folds[tried.front()].hidden.front();
  const auto first_min = static_cast<double>(std::find(hidden.begin(), hidden.end(), true) - hidden.begin());
  EXPECT_NEAR(failed_left_out_um(failing(), folds, in_folds).value(),
              3.0 * (40.0 + 2.0 * 0.5 * (400.0 - first_min) / 60.0) - 40.0, 1e-6);
}

TEST(FailedSensors, AreNotTriedWithoutASensorOrAFold) {
  const FoldedRuns folds = warming(2);
  std::vector<FittedInFold> in_folds = {{folds_for_failures(folds).front(), sloping(1.0)}};
  MatrixSettings intact = failing();
  intact.fails_at.reset();
  EXPECT_FALSE(failed_left_out_um(intact, folds, in_folds).has_value());
  EXPECT_FALSE(failed_left_out_um(failing(), folds, {}).has_value());
  in_folds.front().fitted.sensors.clear();
  EXPECT_FALSE(failed_left_out_um(failing(), folds, in_folds).has_value());
}

}  // namespace
}  // namespace driftwright::compensation::strategy_matrix_test
