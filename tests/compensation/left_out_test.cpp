// Margins of a fail-safe, by what corrections leave on parts left out.

#include "compensation/judging/left_out.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "compensation/predictors/formula_predictor.hpp"

namespace driftwright::compensation::left_out_test {
namespace {

const FoldSettings kFolds{.target = "tip_z", .from_start = false, .thermometers = {"bed"}, .speed = ""};

/// A bed that warms from 20 to 60 degC in 400 min, and a drift that follows it by a law [um] of its rise [K], read every
/// `step` rows.
FoldedRuns warming(const std::function<double(double)>& law, int step = 1) {
  MachineRun run{.cyclogram = {}, .ambient = {}, .readings = {.source = "one", .time_s = {}, .channels = {}}};
  run.readings.channels = {{"bed", "degC", {}}, {"tip_z", "um", {}}};
  for (int i = 0; i <= 400; ++i) {
    run.readings.time_s.push_back(60.0 * i);
    run.readings.channels[0].values.push_back(20.0 + 0.1 * i);
    run.readings.channels[1].values.push_back(i % step == 0 ? law(0.1 * i) : std::numeric_limits<double>::quiet_NaN());
  }
  return folded(std::vector{run}, kFolds);
}

/// 1 um/K, whatever it is fitted to.
std::shared_ptr<const Predictor> proportional() {
  return std::make_shared<FormulaPredictor>(DriftModel{.kind = "line",
                                                       .target = "tip_z",
                                                       .target_unit = "um",
                                                       .intercept = -20.0,
                                                       .terms = {{.input = "bed", .unit = "degC", .coefficient = 1.0}}});
}

const LeftOutSettings kSettings{.target = "tip_z"};

double room_of(const FoldedRuns& folds, DeployedPredictor& d) {
  d.predictor = proportional();
  d.target = "tip_z";
  return set_left_out(d, FoldPredictors(folds.folds.size(), d.predictor), folds, kSettings);
}

double rms_of(const DeployedPredictor& d, const std::string& kind) {
  return std::find_if(d.fold_errors.begin(), d.fold_errors.end(), [&](const FoldError& e) { return e.kind == kind; })
      ->rms_um;
}

TEST(Margins, GrowWhereALeftOutPartShowsThatThePredictionHolds) {
  // the last third lies half of the width of the others' range beyond it: 0.2 and 0.4 widths cut the prediction off
  DeployedPredictor d;
  const FoldedRuns folds = warming([](double rise_K) { return rise_K; });
  EXPECT_EQ(room_of(folds, d), 4.0);
  EXPECT_LT(rms_of(d, "end"), 0.1);
  const FailSafe safe = fail_safe_of(*d.predictor, folds.runs, kSettings, 4.0);
  EXPECT_NEAR(safe.guards.front().high, 60.0 + 4.0 * 0.2 * 40.0, 1e-9);
  EXPECT_NEAR(safe.highest_um, 40.0 + 4.0 * 0.5 * 40.0, 1e-9);
}

TEST(Margins, AreTheSameWhereTheDriftIsReadLessOftenThanTheBed) {
  DeployedPredictor each, fifth;
  EXPECT_EQ(room_of(warming([](double rise_K) { return rise_K; }, 5), fifth),
            room_of(warming([](double rise_K) { return rise_K; }), each));
}

TEST(Margins, AreOfCorrectionsWhoseMissingReadingsAreReplaced) {
  // two thermometers of one body, one of which has no reading for ten of forty minutes
  MachineRun run{.cyclogram = {}, .ambient = {}, .readings = {.source = "one", .time_s = {}, .channels = {}}};
  run.readings.channels = {{"bed", "degC", {}}, {"frame", "degC", {}}, {"tip_z", "um", {}}};
  for (int i = 0; i <= 400; ++i) {
    run.readings.time_s.push_back(60.0 * i);
    run.readings.channels[0].values.push_back(20.0 + 0.1 * i);
    run.readings.channels[1].values.push_back(i % 40 < 10 && i > 40 ? std::numeric_limits<double>::quiet_NaN()
                                                                    : 20.0 + 0.1 * i);
    run.readings.channels[2].values.push_back(0.1 * i);
  }
  const FoldedRuns folds = folded(std::vector{run}, kFolds);
  DeployedPredictor d;
  d.predictor =
      std::make_shared<FormulaPredictor>(DriftModel{.kind = "two",
                                                    .target = "tip_z",
                                                    .target_unit = "um",
                                                    .intercept = -20.0,
                                                    .terms = {{.input = "bed", .unit = "degC", .coefficient = 0.5},
                                                              {.input = "frame", .unit = "degC", .coefficient = 0.5}}});
  d.target = "tip_z";
  (void)set_left_out(d, FoldPredictors(folds.folds.size(), d.predictor), folds, kSettings);
  EXPECT_LT(rms_of(d, "end"), 1.0);  // of 33 um
}

TEST(Margins, StayWhereThePredictionIsWrongBeyond) {
  DeployedPredictor d;
  EXPECT_EQ(room_of(warming([](double rise_K) { return rise_K < 25.0 ? rise_K : std::max(50.0 - rise_K, 0.0) - 25.0; }), d),
            1.0);
}

TEST(Margins, ErrorsAreThoseOfTheGuardedCorrection) {
  // 25 K and more are never reached by the rest: the clamp holds what a bare prediction would leave
  DeployedPredictor d;
  (void)room_of(warming([](double rise_K) { return rise_K < 25.0 ? rise_K : -25.0; }), d);
  std::size_t wrong = 0;
  for (const FoldError& e : d.fold_errors) wrong += e.rms_um < e.within_um ? 1 : 0;
  EXPECT_GT(wrong, 0u);
  EXPECT_LT(rms_of(d, "end"), 60.0);
}

}  // namespace
}  // namespace driftwright::compensation::left_out_test
