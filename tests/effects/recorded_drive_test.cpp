// Effects that follow a recorded column of the drive, by value.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "effects/effect.hpp"
#include "tests/effects/read_entry.hpp"

namespace driftwright::effects::recorded_drive_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const Cyclogram kWithHeater{.name = "run",
                            .sections = {{90, {.speed_rpm = 100}}, {110, {.speed_rpm = 0}}},
                            .remarks = {},
                            .columns = {{"heater", "W", {{0, 60, 120, 180}, {10, 30, 30, 20}}}}};

TEST(RecordedDrive, SplitsTheDriveWhereItsColumnChanges) {
  const Effect e = read("{type: recorded_drive, node: air, column: heater_W, gain: 0.5}");
  const Cyclogram felt = true_cyclogram(drive_change({e}, "run"), kWithHeater);
  ASSERT_EQ(felt.sections.size(), 4u);  // 0, 60, 90 (speed), 180 s: nothing changes at 120 s
  const Law power_W = heat_balance({e}).heats.at(0).power_W;
  const double expected_W[] = {5, 15, 15, 10}, length_s[] = {60, 30, 90, 20};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(power_W({.drive = felt.sections[i].drive}), expected_W[i]);
    EXPECT_DOUBLE_EQ(felt.sections[i].duration_s, length_s[i]);
  }
  EXPECT_EQ(felt.sections[2].drive.speed_rpm, 0.0);
  EXPECT_EQ(power_W(Inputs{}), 0.0) << "a drive without the column";
}

TEST(RecordedDrive, BehindALagKeepsTheHeatOfEachPiece) {
  const Effect e = read("{type: recorded_drive, node: air, column: heater, gain: 1, lag: 2 min}");
  const Cyclogram felt = true_cyclogram(drive_change({e}, "run"), kWithHeater);
  const Law power_W = heat_balance({e}).heats.at(0).power_W;
  // settled at 10 W; from 60 s on y = 30 - 20 exp(-(t - 60) / 120), in pieces of 30 s; from 180 s on towards 20 W.
  // As 120 y' = c - y, the mean of y over a piece is c - 120 (y_end - y_begin) / length.
  const auto y_W = [](double t_s) { return 30.0 - 20.0 * std::exp(-(t_s - 60.0) / 120.0); };
  EXPECT_DOUBLE_EQ(power_W({.drive = felt.drive(30)}), 10.0);
  EXPECT_NEAR(power_W({.drive = felt.drive(70)}), 30.0 - 4.0 * (y_W(90) - y_W(60)), 1e-12);
  EXPECT_NEAR(power_W({.drive = felt.drive(130)}), 30.0 - 4.0 * (y_W(150) - y_W(120)), 1e-12);
  EXPECT_NEAR(power_W({.drive = felt.drive(190)}), 20.0 + (y_W(180) - 20.0) * 6.0 * (1.0 - std::exp(-1.0 / 6.0)), 1e-12);
  EXPECT_EQ(felt.duration_s(), kWithHeater.duration_s());
}

TEST(RecordedDrive, ExchangesWithABodyAsWarmAsTheColumnSays) {
  // Q = G (T - c): a medium at 20 degC and heat that makes up for c
  const HeatBalance b = balance_of("{type: recorded_drive, region: frame, column: bed_degC, conductance: 3 W/K}");
  const Inputs at{.drive = {.signals = {{"bed_degC", 65.0}}}};
  EXPECT_DOUBLE_EQ(b.exchanges.at(0).coefficient(at), 3.0);
  EXPECT_DOUBLE_EQ(b.exchanges.at(0).medium_K.value(), 293.15);
  EXPECT_DOUBLE_EQ(b.heats.at(0).power_W(at), 3.0 * 45.0);
  const HeatBalance valve =
      balance_of("{type: recorded_drive, node: air, column: valve_percent, opening: 0.2, surrounding: tank}");
  EXPECT_DOUBLE_EQ(valve.exchanges.at(0).coefficient({.drive = {.signals = {{"valve_percent", 40.0}}}}), 8.0);
  EXPECT_EQ(valve.exchanges.at(0).surrounding, "tank");
  EXPECT_FALSE(valve.exchanges.at(0).medium_K);
  const HeatBalance stream =
      balance_of("{type: recorded_drive, node: air, column: valve_percent, opening: 0.2, medium: 16 degC}");
  EXPECT_DOUBLE_EQ(stream.exchanges.at(0).coefficient({.drive = {.signals = {{"valve_percent", 40.0}}}}), 8.0);
  EXPECT_DOUBLE_EQ(stream.exchanges.at(0).medium_K.value(), 289.15);
}

TEST(RecordedDrive, TakesChannelsOfTheDriveToo) {
  const Inputs at{.drive = {.feed_m_s = {0.05, 0, 0}, .cutting_power_W = 400}};
  EXPECT_DOUBLE_EQ(
      balance_of("{type: recorded_drive, node: air, column: cutting_power_W, gain: 0.3}").heats.at(0).power_W(at), 120.0);
  EXPECT_DOUBLE_EQ(balance_of("{type: recorded_drive, node: air, column: feed_x, gain: 0.01}").heats.at(0).power_W(at),
                   30.0);
}

TEST(RecordedDrive, HeatsByAPowerOfItsColumn) {
  // copper's loss by a current: 8 W at 4 A, a quarter of that at 2 A, whichever way it flows
  const Law power_W =
      balance_of("{type: recorded_drive, node: air, column: current_A, gain: 2, exponent: 2, at: 4}").heats.at(0).power_W;
  const auto at = [](double current_A) { return Inputs{.drive = {.signals = {{"current_A", current_A}}}}; };
  EXPECT_DOUBLE_EQ(power_W(at(4.0)), 8.0);
  EXPECT_DOUBLE_EQ(power_W(at(2.0)), 2.0);
  EXPECT_DOUBLE_EQ(power_W(at(-2.0)), 2.0);
  EXPECT_EQ(power_W(at(0.0)), 0.0);
}

TEST(RecordedDrive, WantsOneLawAndAColumn) {
  const auto refused = [](const std::string& text) { return ThrowsMessage<InputError>(HasSubstr(text)); };
  EXPECT_THAT([] { read("{type: recorded_drive, node: air, column: heater_W}"); }, refused("one of the three"));
  EXPECT_THAT([] { read("{type: recorded_drive, node: air, column: heater_W, gain: 1, opening: 2}"); },
              refused("one of the three"));
  EXPECT_THAT([] { read("{type: recorded_drive, node: air, gain: 1}"); }, refused("column"));
  EXPECT_THAT([] { read("{type: recorded_drive, node: air, column: heater_W, gain: 1, exponent: 2}"); },
              refused("`gain` holds"));
  EXPECT_THAT([] { read("{type: recorded_drive, node: air, column: valve_1, opening: 1, exponent: 2, at: 3}"); },
              refused("requires a `gain`"));
  EXPECT_THAT([] { read("{type: recorded_drive, node: air, column: feed_x, gain: 1, lag: 3 min}"); }, refused("at once"));
}

}  // namespace
}  // namespace driftwright::effects::recorded_drive_test
