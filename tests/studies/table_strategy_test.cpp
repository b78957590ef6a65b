// What all corrections of a table are judged with.

#include "studies/table_strategy.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftwright::studies::table_strategy_test {
namespace {

struct Case {
  scenarios::Scenario scenario;
  MachineRun felt;
  Record record{.source = "truth", .time_s = {}, .channels = {{"a", "degC", {}}, {"b", "degC", {}}, {"u", "um", {}}}};
};

/// 200 rows every 10 min; a stays at 20.04 degC, b rises by 0.3 K/h, the ambient is 0.27 K above the reference.
Case steady() {
  Case c;
  c.scenario.machine.emplace();
  c.scenario.table.emplace();
  c.felt.ambient = {{0.0, 2e5}, {0.27, 0.27}};
  for (int i = 0; i < 200; ++i) {
    c.record.time_s.push_back(600.0 * i);
    c.record.channels[0].values.push_back(20.04);
    c.record.channels[1].values.push_back(20.0 + 0.05 * i);
    c.record.channels[2].values.push_back(1.23456);
  }
  return c;
}

double rms_off(const std::vector<double>& values, double from) {
  double square = 0.0;
  for (double v : values) square += (v - from) * (v - from) / static_cast<double>(values.size());
  return std::sqrt(square);
}

// 0.1 K of noise and rounding to 0.1 K: 0.104 K; 200 readings know that to 5 %, 3 sigma are allowed. The ambient is read
// by the same instrument.
TEST(TableReadings, HaveTheInstrumentsNoiseAndStepsByDefault) {
  const Case c = steady();
  const Record read = studies::table_readings(c.scenario, c.felt, c.record, 0);
  EXPECT_NEAR(rms_off(read.at("a").values, 20.04), 0.104, 0.016);
  EXPECT_NEAR(rms_off(read.at(studies::kFeltAmbient).values, 20.27), 0.104, 0.016);
  for (double v : read.at("a").values) EXPECT_NEAR(10.0 * v, std::round(10.0 * v), 1e-9);
  EXPECT_EQ(read.at("u").values, c.record.at("u").values);
  EXPECT_NE(studies::table_readings(c.scenario, c.felt, c.record, 1).at("a").values, read.at("a").values);
  EXPECT_EQ(studies::table_readings(c.scenario, c.felt, c.record, 0).at("a").values, read.at("a").values);
}

// A mean over 30 min of readings every 5 min has 7 of them: noise less by sqrt(7), and a ramp of 0.3 K/h late by a
// quarter of an hour.
TEST(TableReadings, AreAveragedBackwardsAtTheControlsUpdates) {
  Case c = steady();
  c.scenario.table->sensor_mean_s = 1800.0;
  c.scenario.table->instrument.resolution_K = 0.0;
  EXPECT_NEAR(rms_off(studies::table_readings(c.scenario, c.felt, c.record, 0).at("a").values, 20.04), 0.1 / std::sqrt(7.0),
              0.011);
  c.scenario.table->instrument.noise_K = 0.0;
  EXPECT_NEAR(studies::table_readings(c.scenario, c.felt, c.record, 0).at("b").values[100], 25.0 - 0.075, 1e-9);
}

// Updates every 25 min: between them the control knows the last one alone.
TEST(TableReadings, AreHeldBetweenUpdates) {
  Case c = steady();
  c.scenario.table->instrument = {};
  c.scenario.table->update_s = 1500.0;
  const Record read = studies::table_readings(c.scenario, c.felt, c.record, 0);
  EXPECT_NEAR(read.at("b").values[4], 20.0 + 0.05 * 2.5, 1e-9);  // at 40 min: of 25 min
  EXPECT_NEAR(read.at("b").values[5], 20.0 + 0.05 * 5.0, 1e-9);
}

TEST(WrongExpansions, AreOthersEachTimeAndTheSameAgain) {
  const scenarios::TableSettings s;
  const studies::ExpansionFactors a = studies::wrong_expansions(s, 0), b = studies::wrong_expansions(s, 1);
  EXPECT_NE(a.table, b.table);
  EXPECT_NE(a.table, a.scale_x);
  EXPECT_EQ(a.scale_y, studies::wrong_expansions(s, 0).scale_y);
  double square = 0.0;
  for (int k = 0; k < 300; ++k) square += std::pow(std::log(studies::wrong_expansions(s, k).table), 2) / 300.0;
  EXPECT_NEAR(std::sqrt(square), 0.03, 0.004);  // 3 %, known to 4 % from 300
}

}  // namespace
}  // namespace driftwright::studies::table_strategy_test
