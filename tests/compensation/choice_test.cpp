// What is left out of training runs in turn, and which strategy is chosen by it.

#include "compensation/judging/choice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "compensation/judging/folds.hpp"
#include "compensation/judging/strategies.hpp"
#include "compensation/predictors/blended_formula.hpp"
#include "compensation/predictors/deployed_predictor.hpp"
#include "compensation/predictors/driven_predictor.hpp"
#include "compensation/sensors/blocks.hpp"

namespace driftwright::compensation::choice_test {
namespace {

using ::testing::ElementsAre;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Sixty minutes at one speed; the bed warms by 0.1 K a minute from a start.
MachineRun run_of(const std::string& name, double speed_rpm, double start_degC) {
  MachineRun run{.cyclogram = {}, .ambient = {}, .readings = {.source = name, .time_s = {}, .channels = {}}};
  run.readings.channels = {{"speed", "rpm", {}}, {"bed", "degC", {}}, {"tip_z", "um", {}}};
  for (int i = 0; i < 60; ++i) {
    run.readings.time_s.push_back(60.0 * i);
    run.readings.channels[0].values.push_back(speed_rpm);
    run.readings.channels[1].values.push_back(start_degC + 0.1 * i);
    run.readings.channels[2].values.push_back(0.5 * i);
  }
  return run;
}

const FoldSettings kSettings{.target = "tip_z", .from_start = true, .thermometers = {"bed"}, .speed = "speed"};

std::size_t n_hidden(const Fold& fold, std::size_t run) {
  return static_cast<std::size_t>(std::count(fold.hidden[run].begin(), fold.hidden[run].end(), true));
}

TEST(Folds, HideRunsSpeedsEndsAndTheWarmest) {
  const std::vector<MachineRun> runs = {run_of("a", 1000.0, 20.0), run_of("b", 2000.0, 30.0), run_of("c", 2000.0, 20.0)};
  std::vector<std::string> names;
  const std::vector<Fold> folds = folds_of(runs, kSettings);
  for (const Fold& f : folds) names.push_back(f.name);
  ASSERT_THAT(names, ElementsAre("a", "b", "c", "speed 1000 rpm", "speed 2000 rpm", "last third of each run",
                                 "first third of each run", "warmest third", "coldest third"));
  EXPECT_EQ(n_hidden(folds[0], 0), 60u);  // a whole run
  EXPECT_EQ(n_hidden(folds[0], 1), 0u);
  EXPECT_EQ(n_hidden(folds[4], 0), 0u);  // 2000 rpm: both runs that had it
  EXPECT_EQ(n_hidden(folds[4], 1), 60u);
  EXPECT_EQ(n_hidden(folds[4], 2), 60u);
  EXPECT_EQ(n_hidden(folds[5], 0), 20u);
  EXPECT_TRUE(folds[5].hidden[0][59]);
  EXPECT_EQ(n_hidden(folds[6], 0), 19u);  // the first row says what the drift counts from
  EXPECT_FALSE(folds[6].hidden[0][0]);
  EXPECT_EQ(n_hidden(folds[7], 1), 60u);  // "b" is the warm one, and wholly
  EXPECT_EQ(n_hidden(folds[7], 0), 0u);
  EXPECT_EQ(n_hidden(folds[8], 1), 0u);

  const std::vector<MachineRun> rest = without(runs, folds[4], "tip_z");
  ASSERT_EQ(rest.size(), 1u);
  EXPECT_EQ(rest[0].readings.source, "a");
  const std::vector<MachineRun> cut = without(runs, folds[5], "tip_z");
  ASSERT_EQ(cut.size(), 3u);
  EXPECT_TRUE(std::isnan(cut[0].readings.at("tip_z").values[40]));
  EXPECT_EQ(cut[0].readings.at("tip_z").values[39], 19.5);
  EXPECT_EQ(cut[0].readings.at("bed").values[40], 24.0);  // readings are never hidden
}

// A run that begins at the speed that is hidden, and goes on at another: what its drift counts from stays.
TEST(Folds, OfSpeedsKeepWhatTheDriftCountsFrom) {
  std::vector<MachineRun> runs = {run_of("a", 1000.0, 20.0), run_of("b", 2000.0, 20.0)};
  std::vector<double>& speed = runs[0].readings.channels[0].values;
  std::fill(speed.begin() + 30, speed.end(), 2000.0);
  for (const Fold& f : folds_of(runs, kSettings)) {
    if (f.name != "speed 1000 rpm") continue;
    EXPECT_FALSE(f.hidden[0][0]);
    EXPECT_EQ(n_hidden(f, 0), 29u);
    EXPECT_EQ(without(runs, f, "tip_z")[0].readings.at("tip_z").values[0], 0.0);
    return;
  }
  FAIL() << "no fold of 1000 rpm";
}

TEST(Folds, OfOneRunAreItsEighths) {
  const std::vector<MachineRun> runs = {run_of("a", 0.0, 20.0)};
  std::vector<std::string> kinds;
  for (const Fold& f : folds_of(runs, kSettings)) kinds.push_back(f.kind);
  // an eighth of 60 rows is seven or eight rows: too few to judge by
  EXPECT_THAT(kinds, ElementsAre("end", "beginning", "warm", "cold"));
  MachineRun twice = runs[0];
  for (int i = 60; i < 120; ++i) {
    twice.readings.time_s.push_back(60.0 * i);
    for (Channel& c : twice.readings.channels) c.values.push_back(c.values.back() + (c.unit == "rpm" ? 0.0 : 0.1));
  }
  kinds.clear();
  const std::vector<MachineRun> longer = {twice};
  for (const Fold& f : folds_of(longer, kSettings)) kinds.push_back(f.kind);
  EXPECT_THAT(kinds, ElementsAre("block", "block", "block", "block", "block", "block", "block", "block", "end", "beginning",
                                 "warm", "cold"));
}

TEST(Blocks, PartOneRecordAndLeaveSeveral) {
  Record r{.source = "r", .time_s = {}, .channels = {{"x", "K", {}}, {"tip_z", "um", {}}}};
  for (int i = 0; i < 40; ++i) {
    r.time_s.push_back(60.0 * i);
    r.channels[0].values.push_back(i);
    r.channels[1].values.push_back(i < 8 ? kMissing : i);
  }
  const std::vector<Record> blocks = in_blocks({r}, "tip_z");
  ASSERT_EQ(blocks.size(), kBlocks);
  int n = 0;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    EXPECT_EQ(blocks[b].channels[0].values, r.channels[0].values);
    for (int i = 0; i < 40; ++i) {
      const double v = blocks[b].channels[1].values[static_cast<std::size_t>(i)];
      if (std::isnan(v)) continue;
      ++n;
      EXPECT_EQ((i - 8) / 4, static_cast<int>(b));
    }
  }
  EXPECT_EQ(n, 32);
  EXPECT_EQ(in_blocks({r, r}, "tip_z").size(), 2u);
  EXPECT_DOUBLE_EQ(longest_lag_s({r}, "tip_z"), 60.0 * 39 / 3);
}

DeployedPredictor with_errors(const std::string& name, const std::vector<double>& rms_um) {
  DeployedPredictor d;
  d.name = name;
  const char* kinds[] = {"run", "run", "run", "end"};
  for (std::size_t k = 0; k < rms_um.size(); ++k) d.fold_errors.push_back({kinds[k], "", rms_um[k], 2.0 * rms_um[k]});
  return d;
}

/// One that knows the machine's drive.
DeployedPredictor model_with_errors(const std::string& name, const std::vector<double>& rms_um) {
  DeployedPredictor d = with_errors(name, rms_um);
  d.predictor = std::make_shared<DrivenPredictor>(
      [](const Cyclogram&, const TimeSeries&, const std::vector<double>& t) { return std::vector<double>(t.size()); });
  return d;
}

std::string chosen_of(const std::vector<DeployedPredictor>& list) {
  return choose(list).name;
}

TEST(Choice, WeighsKindsAlikeHoweverManyFoldsTheyHave) {
  EXPECT_DOUBLE_EQ(left_out_um(with_errors("", {1.0, 1.0, 1.0, 16.0})), 4.0);
  EXPECT_EQ(left_out_um(with_errors("", {})), std::numeric_limits<double>::infinity());
}

TEST(Choice, IsTheBlendUnlessAnotherIsBetterBeyondChance) {
  const DeployedPredictor blend = with_errors(kBlend, {2.0, 2.0, 2.0, 2.0});
  EXPECT_EQ(chosen_of({with_errors("a", {1.5, 1.5, 1.5, 1.5}), blend}), kBlend);  // alike
  EXPECT_EQ(chosen_of({with_errors("a", {0.5, 0.5, 0.5, 0.4}), blend}), "a");
  // better in one fold by far, which may be chance
  EXPECT_EQ(chosen_of({with_errors("a", {2.0, 2.0, 2.0, 0.1}), blend}), kBlend);
}

TEST(Choice, IsAModelOfTheMachineWhereItIsAlike) {
  const DeployedPredictor blend = with_errors(kBlend, {1.0, 1.0, 1.0, 1.0});
  EXPECT_EQ(chosen_of({model_with_errors("model", {1.3, 1.4, 1.4, 1.4}), blend}), "model");
  EXPECT_EQ(chosen_of({model_with_errors("model", {1.6, 1.7, 1.6, 1.6}), blend}), kBlend);
  // of two that are alike the simpler one, which depends on fewer sensors
  EXPECT_EQ(chosen_of({model_with_errors("modes", {1.3, 1.3, 1.3, 1.3}), model_with_errors("observer", {1.0, 1.0, 1.0, 1.0}),
                       blend}),
            "modes");
  EXPECT_EQ(chosen_of({model_with_errors("modes", {1.6, 1.6, 1.6, 1.6}), model_with_errors("observer", {1.0, 1.0, 1.0, 1.0}),
                       blend}),
            "observer");
  // and the one that is safer with a failed sensor
  std::vector<DeployedPredictor> two = {model_with_errors("modes", {1.0, 1.0, 1.0, 1.0}),
                                        model_with_errors("observer", {1.3, 1.3, 1.3, 1.3})};
  two[0].failed_um = 16.7;
  two[1].failed_um = 13.3;
  EXPECT_EQ(chosen_of(two), "observer");
  two[1].failed_um = 44.9;
  EXPECT_EQ(chosen_of(two), "modes");
}

TEST(Choice, TakesTheSimplestWithinOneStandardErrorOfTheBest) {
  EXPECT_EQ(chosen_of({with_errors("simple", {1.1, 0.9, 1.2, 1.0}), with_errors("best", {1.0, 1.0, 1.0, 1.0})}), "simple");
  EXPECT_EQ(chosen_of({with_errors("simple", {3.0, 3.1, 3.0, 3.1}), with_errors("best", {1.0, 1.0, 1.0, 1.0})}), "best");
  EXPECT_EQ(chosen_of({with_errors("unfitted", {}), with_errors("best", {1.0, 1.0, 1.0, 1.0})}), "best");
  EXPECT_EQ(chosen_of({with_errors("unfitted", {})}), "");
}

TEST(Choice, IsNothingWhereCorrectionsDoNotGain) {
  const DeployedPredictor none = with_errors(kNoCorrection, {2.0, 3.0, 3.0, 3.0});
  const DeployedPredictor worse = with_errors(kBlend, {1.0, 4.0, 4.0, 4.0}),
                          better = with_errors(kBlend, {2.0, 2.9, 2.9, 3.0});
  EXPECT_EQ(chosen_of({none, worse}), "");
  EXPECT_NE(choose(std::vector{none, worse}).why, "");
  EXPECT_EQ(chosen_of({none, model_with_errors("model", {3.1, 3.0, 3.0, 3.0})}), "");
  EXPECT_EQ(chosen_of({none, better}), kBlend);
}

TEST(Blend, OfFormulasIsTheMeanOfWhatTheySay) {
  const DriftModel a{.kind = "a",
                     .target = "tip_z",
                     .target_unit = "um",
                     .intercept = 1.0,
                     .terms = {{.input = "bed", .unit = "degC", .coefficient = 2.0},
                               {.input = "speed", .unit = "rpm", .coefficient = 1e-3, .power = 2, .lag_s = 300.0}}};
  DriftModel b = a;
  b.intercept = -4.0;
  b.terms = {{.input = "bed", .unit = "degC", .coefficient = 0.5},
             {.input = "bed", .unit = "degC", .coefficient = 1.0, .lag_s = 600.0},
             {.input = "speed", .unit = "rpm", .coefficient = 3.0, .is_running = true}};
  const DriftModel mean = mean_of(std::vector<DriftModel>{a, b}, "blend");
  EXPECT_EQ(mean.terms.size(), 4u);
  const Record r = run_of("r", 1500.0, 20.0).readings;
  const std::vector<double> of_a = a.predict(r), of_b = b.predict(r), of_mean = mean.predict(r);
  for (std::size_t i = 0; i < of_a.size(); ++i) EXPECT_NEAR(of_mean[i], 0.5 * (of_a[i] + of_b[i]), 1e-9);
}

TEST(Interval, GrowsAsTrustFalls) {
  DeployedPredictor d;
  EXPECT_FALSE(interval_in_force_um(d, 1.0));
  d.interval_um = 3.0;
  EXPECT_EQ(interval_in_force_um(d, 1.0), 3.0);
  EXPECT_EQ(interval_in_force_um(d, 0.5), 6.0);
  EXPECT_EQ(interval_in_force_um(d, 1.0, 1.0), 3.0);           // 1.96 of its own deviations are less
  EXPECT_DOUBLE_EQ(*interval_in_force_um(d, 0.5, 4.0), 7.84);  // and more
  EXPECT_FALSE(interval_in_force_um(d, 0.0));
}

}  // namespace
}  // namespace driftwright::compensation::choice_test
