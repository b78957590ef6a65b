#include "scenarios/reader/recorded_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::scenarios::recorded_run_test {
namespace {

using ::testing::DoubleNear, ::testing::Each, ::testing::HasSubstr, ::testing::IsEmpty, ::testing::SizeIs;

/// Rows a minute apart, from 300 s on: two minutes of 1000 rpm, one of a jitter about it, rest.
Record record() {
  Record r{.source = "monday.csv", .time_s = {}, .channels = {{"speed", "rpm", {1000, 1000, 1004, 0, 0}}}};
  for (int i = 0; i < 5; ++i) r.time_s.push_back(300.0 + 60.0 * i);
  return r;
}
Record with(Record r, Channel channel) {
  r.channels.push_back(std::move(channel));
  return r;
}
const double kMissing = std::nan("");

TEST(MachineRun, IsDrivenFromEachRowOnAndCountsFromTheFirst) {
  const MachineRun run = run_of(record(), nullptr, {}, Reading::kStrict);
  EXPECT_EQ(run.readings.time_s, (std::vector<double>{0, 60, 120, 180, 240}));
  ASSERT_THAT(run.cyclogram.sections, SizeIs(2));  // 0.4 % of the top speed is no other speed
  EXPECT_EQ(run.cyclogram.sections[0].duration_s, 180.0);
  EXPECT_EQ(run.cyclogram.sections[0].drive.speed_rpm, 1000.0);
  EXPECT_EQ(run.cyclogram.sections[1].drive.speed_rpm, 0.0);
}

// A tachometer's jitter returns to the old reading. A command of 0.7 % less stays, and a twin that ignored it would have the
// wrong heat.
TEST(MachineRun, ASmallChangeOfSpeedThatStaysIsNoJitter) {
  Record r = record();
  r.time_s.clear();
  r.channels[0].values = {15400, 15410, 15400, 15300, 15300, 15300, 15310, 15300};
  for (int i = 0; i < 8; ++i) r.time_s.push_back(60.0 * i);
  const MachineRun run = run_of(r, nullptr, {}, Reading::kStrict);
  ASSERT_THAT(run.cyclogram.sections, SizeIs(2));
  EXPECT_EQ(run.cyclogram.sections[0].duration_s, 180.0);
  EXPECT_EQ(run.cyclogram.sections[1].drive.speed_rpm, 15300.0);
}

TEST(MachineRun, TakesFeedsAndCuttingPowerWhereTheyAreRecorded) {
  const Record r =
      with(with(record(), {"feed_y", "mm_min", {600, 600, 600, 0, 0}}), {"cutting_power", "W", {0, 0, 0, 250, 250}});
  const MachineRun run = run_of(r, nullptr, {}, Reading::kStrict);
  ASSERT_THAT(run.cyclogram.sections, SizeIs(2));
  EXPECT_DOUBLE_EQ(run.cyclogram.sections[0].drive.feed_m_s[1], 0.01);
  EXPECT_EQ(run.cyclogram.sections[1].drive.cutting_power_W, 250.0);
}

TEST(MachineRun, KnowsTheAmbientFromAmbientFromASensorOnItOrFromTheMachine) {
  MachineModel machine;
  machine.ambient = {{0.0}, {3.0}};
  const Channel ambient{"ambient", "degC", {22, 22, kMissing, 22, 22}};
  const Channel sensor{"t_air", "degC", {24, 24, 24, 24, 24}};
  const MachineRun by_ambient = run_of(with(with(record(), sensor), ambient), &machine, {"t_air"}, Reading::kStrict);
  EXPECT_TRUE(by_ambient.has_recorded_ambient());
  EXPECT_THAT(by_ambient.ambient.value, Each(DoubleNear(2.0, 1e-9)));  // over 20 degC
  EXPECT_THAT(run_of(with(record(), sensor), &machine, {"t_air"}, Reading::kStrict).ambient.value,
              Each(DoubleNear(4.0, 1e-9)));
  const MachineRun without = run_of(record(), &machine, {}, Reading::kStrict);
  EXPECT_FALSE(without.has_recorded_ambient());
  EXPECT_EQ(without.ambient.value, machine.ambient.value);
  // it is unknown: it has no knot and must not be read
  const MachineRun unknown = run_of(record(), nullptr, {}, Reading::kStrict);
  EXPECT_THAT(unknown.ambient.time_s, IsEmpty());
  EXPECT_THROW((void)unknown.ambient.at(0.0), std::logic_error);
}

// What a control cannot know is not made up: a gap holds the last reading, whatever comes after it.
TEST(MachineRun, HoldsTheAmbientOverGapsAtTheRowsOwnTimes) {
  const Channel ambient{"ambient", "degC", {20.5, 21, kMissing, kMissing, 25}};
  const MachineRun run = run_of(with(record(), ambient), nullptr, {}, Reading::kStrict);
  EXPECT_NEAR(run.ambient.at(30.0), 0.75, 1e-9);  // from 0, not from the record's 300 s
  EXPECT_NEAR(run.ambient.at(180.0), 1.0, 1e-9);
  EXPECT_NEAR(run.ambient.at(240.0), 5.0, 1e-9);
  ASSERT_THAT(run.findings, SizeIs(1));
  EXPECT_THAT(run.findings[0].what, HasSubstr("no reading in 40 % of the rows"));
}

TEST(MachineRun, TakesASensorOnTheAmbientWhereAmbientIsEmpty) {
  const Record r = with(with(record(), {"ambient", "degC", std::vector<double>(5, kMissing)}),
                        {"t_air", "degC", std::vector<double>(5, 21.0)});
  EXPECT_EQ(run_of(r, nullptr, {"t_air"}, Reading::kStrict).ambient_channel, "t_air");
}

TEST(MachineRun, HoldsFeedsThatAreMissingAndRefusesForeignOnes) {
  const MachineRun held =
      run_of(with(record(), {"feed_x", "mm_min", {600, kMissing, 600, kMissing, 600}}), nullptr, {}, Reading::kStrict);
  ASSERT_THAT(held.cyclogram.sections, SizeIs(2));
  EXPECT_DOUBLE_EQ(held.cyclogram.sections[1].drive.feed_m_s[0], 0.01);
  const MachineRun to_and_fro =
      run_of(with(record(), {"feed_z", "mm_min", {600, -600, 600, -600, 600}}), nullptr, {}, Reading::kStrict);
  for (const Cyclogram::Section& s : to_and_fro.cyclogram.sections) EXPECT_DOUBLE_EQ(s.drive.feed_m_s[2], 0.01);
  for (const Channel& foreign : {Channel{"feed_x", "percent", std::vector<double>(5, 60.0)},
                                 Channel{"cutting_power", "percent", std::vector<double>(5, 60.0)},
                                 Channel{"feed_z", "mm_min", {600, 7e6, 600, 7e6, 600}}})
    EXPECT_THROW((void)run_of(with(record(), foreign), nullptr, {}, Reading::kStrict), InputError) << foreign.header();
}

TEST(MachineRun, AnEmptyAmbientIsNone) {
  const Channel ambient{"ambient", "degC", std::vector<double>(5, kMissing)};
  const MachineRun run = run_of(with(record(), ambient), nullptr, {}, Reading::kStrict);
  EXPECT_FALSE(run.has_recorded_ambient());
  ASSERT_THAT(run.findings, SizeIs(1));
  EXPECT_THAT(run.findings[0].what, HasSubstr("no ambient temperature"));
}

TEST(MachineRun, RefusesStrictlyWhatItSaysLeniently) {
  MachineModel machine;
  machine.ambient = {{0.0}, {0.0}};
  Record no_speed = record();
  no_speed.channels[0].name = "torque";
  Record reversed = record();
  reversed.channels[0].values[1] = -500.0;
  Record empty = record();
  empty.channels[0].values.assign(5, kMissing);
  Record in_percent = record();
  in_percent.channels[0].unit = "percent";
  const Record kelvin = with(record(), {"ambient", "degC", std::vector<double>(5, 293.0)});
  const Record volts = with(record(), {"ambient", "V", std::vector<double>(5, 0.2)});
  const std::pair<Record, const char*> cases[] = {{no_speed, "no channel speed_rpm"}, {reversed, "speeds must be positive"},
                                                  {empty, "speed_rpm is empty"},      {in_percent, "it must be in rpm"},
                                                  {kelvin, "looks like kelvin"},      {volts, "it must be in degC"}};
  for (const auto& [bad, words] : cases) {
    EXPECT_REFUSED(run_of(bad, &machine, {}, Reading::kStrict), "monday.csv", words);
    const MachineRun run = run_of(bad, &machine, {}, Reading::kLenient);
    ASSERT_FALSE(run.findings.empty()) << words;
    EXPECT_THAT(run.findings[0].what, HasSubstr(words));
    EXPECT_TRUE(run.findings[0].leaves_out);
  }
  EXPECT_THAT(run_of(no_speed, &machine, {}, Reading::kLenient).cyclogram.sections, IsEmpty());
}

}  // namespace
}  // namespace driftwright::scenarios::recorded_run_test
