// Every predictor gives for a row the same as for the whole run, and uses no row after it.

#include "compensation/predictors/predictor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "compensation/predictors/driven_predictor.hpp"
#include "compensation/predictors/formula_predictor.hpp"
#include "compensation/predictors/past_drift.hpp"
#include "tests/shared/sensor_records.hpp"

namespace driftwright::compensation::predictor_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsNan;

/// Four thermometers with holes and a speed.
MachineRun run_with_holes() {
  MachineRun run{.cyclogram = {.name = "work", .sections = {{9e4, {.speed_rpm = 1500.0}}}},
                 .ambient = {{0.0, 9000.0}, {0.0, 1.5}},
                 .readings = fixtures::sensor_record(3, 300, 4, 0.02, 0.1)};
  Record& r = run.readings;
  r.channels.push_back({"spindle", "rpm", {}});
  for (std::size_t i = 0; i < r.n_samples(); ++i) {
    r.time_s[i] = 100.0 + 60.0 * static_cast<double>(i);
    r.channels.back().values.push_back(i / 40 % 2 == 0 ? 1500.0 : 0.0);
  }
  r.channels[0].values[0] = r.channels[0].values[1] = r.channels[1].values[77] = NAN;
  return run;
}

DriftModel formula(bool from_start) {
  return {.kind = "regression with lags",
          .target = "drift_y",
          .target_unit = "um",
          .intercept = 1.0 / 3.0,
          .terms = {{.input = "X3", .unit = "degC", .coefficient = -0.7},
                    {.input = "X1", .unit = "degC", .coefficient = 2.3, .lag_s = 780.0},
                    {.input = "X2", .unit = "degC", .coefficient = 0.02, .power = 2, .lag_s = 3000.0},
                    {.input = "spindle", .unit = "rpm", .coefficient = 1e-6, .power = 2, .lag_s = 1200.0},
                    {.input = "spindle", .unit = "rpm", .coefficient = 3.0, .lag_s = 900.0, .is_running = true},
                    {.input = "spindle", .unit = "rpm", .coefficient = 1e-3}},
          .from_start = from_start};
}

void expect_equal(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) || std::isnan(b[i])) {
      EXPECT_TRUE(std::isnan(a[i]) && std::isnan(b[i])) << i;
    } else {
      EXPECT_EQ(a[i], b[i]) << i;
    }
  }
}

TEST(Predictor, AFormulaRowByRowIsTheFormulaOfTheWholeRecord) {
  const MachineRun run = run_with_holes();
  for (const bool from_start : {false, true}) {
    const std::vector<double> whole = formula(from_start).predict(run.readings);
    EXPECT_TRUE(std::isnan(whole[1]) && std::isfinite(whole[2]) && std::isnan(whole[77]));
    expect_equal(live(FormulaPredictor(formula(from_start)), run), whole);
  }
}

// A lag of 10 min after a speed of 0.1 rad/s: c (1 - exp(-t / lag)) from standstill.
TEST(Predictor, ALagOfSpeedIsItsClosedForm) {
  const FormulaPredictor p({.kind = "lag",
                            .target = "z",
                            .target_unit = "um",
                            .intercept = 0.0,
                            .terms = {{.input = "spindle", .unit = "rpm", .coefficient = 0.01, .lag_s = 600.0}}});
  MachineRun run{
      .cyclogram = {}, .ambient = {}, .readings = {.source = {}, .time_s = {}, .channels = {{"spindle", "rpm", {}}}}};
  for (int i = 0; i < 50; ++i) {
    run.readings.time_s.push_back(40.0 * i);
    run.readings.channels[0].values.push_back(3000.0);
  }
  const std::vector<double> drift_um = live(p, run);
  for (std::size_t i = 0; i < drift_um.size(); ++i)
    EXPECT_NEAR(drift_um[i], 30.0 * (1.0 - std::exp(-run.readings.time_s[i] / 600.0)), 1e-12);
  expect_equal(ahead(p, run), drift_um);  // the speed is known before the run
}

TEST(Predictor, ARunMayGrowBetweenRows) {
  const MachineRun whole = run_with_holes();
  const FormulaPredictor p(formula(true));
  const std::vector<double> at_once = live(p, whole);
  const std::unique_ptr<Follower> follower = p.follow();
  MachineRun growing{.cyclogram = whole.cyclogram,
                     .ambient = whole.ambient,
                     .readings = {.source = {}, .time_s = {}, .channels = whole.readings.channels}};
  for (Channel& c : growing.readings.channels) c.values.clear();
  std::vector<double> row_by_row;
  for (std::size_t i = 0; i < whole.readings.n_samples(); ++i) {
    growing.readings.time_s.push_back(whole.readings.time_s[i]);
    for (std::size_t c = 0; c < growing.readings.channels.size(); ++c)
      growing.readings.channels[c].values.push_back(whole.readings.channels[c].values[i]);
    row_by_row.push_back(follower->next(growing));
  }
  expect_equal(row_by_row, at_once);
}

TEST(Predictor, WhatHasToReadSaysNothingAhead) {
  MachineRun known = run_with_holes();
  std::erase_if(known.readings.channels, [](const Channel& c) { return c.unit == "degC"; });
  EXPECT_THAT(ahead(FormulaPredictor(formula(false)), known), ::testing::Each(IsNan()));
  EXPECT_THAT(ahead(ConstantPredictor(2.5), known), ::testing::Each(2.5));
  const MachineRun foretold = run_with_holes();  // temperatures that a model foretells are read
  expect_equal(ahead(FormulaPredictor(formula(false)), foretold), live(FormulaPredictor(formula(false)), foretold));
}

TEST(Predictor, EarlierRunsAreTheirMeanAtTheSameTime) {
  const std::vector<Record> runs = {{"a", {0.0, 100.0, 200.0}, {{"z", "um", {0.0, 10.0, NAN}}}},
                                    {"b", {0.0, 200.0}, {{"z", "um", {2.0, 6.0}}}}};
  const EarlierRunsPredictor p(runs, "z");
  const MachineRun run{
      .cyclogram = {}, .ambient = {}, .readings = {.source = {}, .time_s = {0.0, 50.0, 150.0, 201.0}, .channels = {}}};
  EXPECT_THAT(live(p, run), ElementsAre(1.0, 4.0, 5.0, IsNan()));
}

// 2 um/K of the ambient, and 1e-3 um/rpm of the spindle: known before the run, and followed while it grows.
TEST(Predictor, WhatFollowsFromTheDriveIsKnownAheadAndFollowsAGrowingRun) {
  int n_asked = 0;
  const DrivenPredictor p([&](const Cyclogram& cyclogram, const TimeSeries& ambient, const std::vector<double>& time_s) {
    ++n_asked;
    std::vector<double> drift_um;
    for (double t_s : time_s) drift_um.push_back(2.0 * ambient.at(t_s) + 1e-3 * cyclogram.speed_rpm(t_s));
    return drift_um;
  });
  const MachineRun run{.cyclogram = {.name = "work", .sections = {{100.0, {.speed_rpm = 3000.0}}, {900.0, {}}}},
                       .ambient = {{0.0, 200.0}, {0.0, 1.0}},
                       .readings = {.source = {}, .time_s = {0.0, 50.0, 150.0, 300.0}, .channels = {}}};
  EXPECT_THAT(ahead(p, run), ElementsAre(3.0, 3.5, 1.5, 2.0));
  EXPECT_EQ(n_asked, 1);
  const std::unique_ptr<Follower> follower = p.follow();
  MachineRun growing = run;
  growing.readings.time_s.clear();
  std::vector<double> row_by_row;
  for (double t_s : run.readings.time_s) {
    growing.readings.time_s.push_back(t_s);
    row_by_row.push_back(follower->next(growing));
  }
  expect_equal(row_by_row, live(p, run));
  const DrivenPredictor too_short(
      [](const Cyclogram&, const TimeSeries&, const std::vector<double>&) { return std::vector<double>{1.0}; });
  EXPECT_THROW((void)live(too_short, run), std::logic_error);
}

TEST(Predictor, AnInputInAnotherUnitIsRefused) {
  MachineRun run = run_with_holes();
  run.readings.channels[2].unit = "K";
  EXPECT_THROW((void)live(FormulaPredictor(formula(false)), run), InputError);
  run.readings.channels.erase(run.readings.channels.begin() + 2);
  EXPECT_THROW((void)live(FormulaPredictor(formula(false)), run), InputError);
}

}  // namespace
}  // namespace driftwright::compensation::predictor_test
