// What the record of drive and ambient gets wrong, as the user writes it, by value; and what it refuses.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/errors.hpp"
#include "effects/effect.hpp"
#include "tests/effects/read_entry.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::effects::drive_effects_test {
namespace {

using ::testing::ElementsAre;

DriveChange change_of(const std::string& text, const std::string& run = "shift") {
  return drive_change({read(text)}, run);
}

Cyclogram::Section turning(double duration_s, double speed_rpm) {
  return {duration_s, {.speed_rpm = speed_rpm, .feed_m_s = {0.1, 0.0, 0.0}, .cutting_power_W = 50.0}};
}
const Cyclogram kRecorded{.name = "shift", .sections = {turning(600, 1000), turning(600, 3000), turning(300, 0)}};

std::vector<double> durations_s(const Cyclogram& c) {
  std::vector<double> found;
  for (const auto& section : c.sections) found.push_back(section.duration_s);
  return found;
}
std::vector<double> speeds_rpm(const Cyclogram& c) {
  std::vector<double> found;
  for (const auto& section : c.sections) found.push_back(section.drive.speed_rpm);
  return found;
}

TEST(TrueCyclogram, IsTheRecordedOneWithoutChange) {
  EXPECT_EQ(true_cyclogram({}, kRecorded).sections, kRecorded.sections);
}

TEST(TrueCyclogram, OverrideScalesTheSpindleAlone) {
  Cyclogram expected = kRecorded;
  expected.sections[0].drive.speed_rpm = 1250.0;
  expected.sections[1].drive.speed_rpm = 3750.0;
  EXPECT_EQ(true_cyclogram(change_of("{type: speed_override, factor: 1.25}"), kRecorded).sections, expected.sections);
}

TEST(TrueCyclogram, AnOverrideInWindowsHoldsInTheseAlone) {
  const Cyclogram felt = true_cyclogram(
      change_of("{type: speed_override, factor: 0.5, windows: [[8 min, 13 min], [20 min, 30 min]]}"), kRecorded);
  EXPECT_THAT(durations_s(felt), ElementsAre(480, 120, 180, 420, 300));
  EXPECT_THAT(speeds_rpm(felt), ElementsAre(1000, 500, 1500, 3000, 0));  // the spindle is at rest in the second one
}

TEST(TrueCyclogram, AnOverrideComesAgain) {
  const Cyclogram felt = true_cyclogram(
      change_of("{type: speed_override, factor: 2, windows: [[1 min, 2 min]], every: 8 min, until_time: 15 min}"),
      kRecorded);
  EXPECT_THAT(durations_s(felt), ElementsAre(60, 60, 420, 60, 600, 300));
  EXPECT_THAT(speeds_rpm(felt), ElementsAre(1000, 2000, 1000, 2000, 3000, 0));
}

TEST(TrueCyclogram, ALimitIsNeverExceeded) {
  EXPECT_THAT(speeds_rpm(true_cyclogram(change_of("{type: speed_override, at_most: 2000 rpm}"), kRecorded)),
              ElementsAre(1000, 2000, 0));
  EXPECT_THAT(speeds_rpm(true_cyclogram(change_of("{type: speed_override, factor: 3, at_most: 4000 rpm}"), kRecorded)),
              ElementsAre(3000, 4000, 0));
  EXPECT_THAT(speeds_rpm(true_cyclogram(change_of("{type: speed_override, at_most: 2500 rpm, windows: [[10 min, 15 min]]}"),
                                        kRecorded)),
              ElementsAre(1000, 2500, 3000, 0));
}

TEST(TrueCyclogram, AnOverrideIsReadBackAsItIsWritten) {
  for (const char* text : {"{type: speed_override, factor: 1}", "{type: speed_override, at_most: 2000 rpm}",
                           "{type: speed_override, factor: 1, windows: [[10 min, 15 min]]}"}) {
    const Effect once = read(text);
    EXPECT_EQ(yaml_of(read(yaml_of(once))), yaml_of(once));
  }
}

TEST(TrueCyclogram, OverridesMultiply) {
  const DriveChange twice =
      drive_change({read("{type: speed_override, factor: 1.25}"), read("{type: speed_override, factor: 2}")}, "shift");
  EXPECT_THAT(speeds_rpm(true_cyclogram(twice, kRecorded)), ElementsAre(2500, 7500, 0));
}

TEST(TrueCyclogram, AStopSplitsTheSectionsItCrosses) {
  const Cyclogram felt = true_cyclogram(change_of("{type: missing_stop, start: 8 min, length: 5 min}"), kRecorded);
  EXPECT_THAT(durations_s(felt), ElementsAre(480, 120, 180, 420, 300));
  EXPECT_THAT(speeds_rpm(felt), ElementsAre(1000, 0, 0, 3000, 0));
  for (const auto& section : felt.sections) {
    EXPECT_EQ(section.drive.feed_m_s[0], 0.1);
    EXPECT_EQ(section.drive.cutting_power_W, 50.0);
  }
}

TEST(TrueCyclogram, AStopAtTheEndsCutsNothingEmptyOff) {
  const Cyclogram felt = true_cyclogram(change_of("{type: missing_stop, start: 10 min, length: 10 min}"), kRecorded);
  EXPECT_THAT(durations_s(felt), ElementsAre(600, 600, 300));
  EXPECT_THAT(speeds_rpm(felt), ElementsAre(1000, 0, 0));
  const Cyclogram beyond = true_cyclogram(change_of("{type: missing_stop, start: 15 min, length: 10 h}"), kRecorded);
  EXPECT_THAT(durations_s(beyond), ElementsAre(600, 300, 300, 300));
  EXPECT_THAT(speeds_rpm(beyond), ElementsAre(1000, 3000, 0, 0));
}

TEST(TrueCyclogram, EndsWhenTheRecordedOneDoesToTheLastBit) {
  // Output at the end of the record must not lie after the last section of the run.
  const Cyclogram uneven{.name = "uneven", .sections = {turning(1000.0 / 7.0, 1000.0), turning(1000.0 / 3.0, 2000.0)}};
  for (int i = 1; i < 1200; ++i) {
    Effect stop = make_effect("missing_stop", Place::kSpindle, "spindle");
    stop.set("start", 0.37 * i / 60.0);
    stop.set("length", 0.7 / 60.0);
    const Cyclogram felt = true_cyclogram(drive_change({stop}, "uneven"), uneven);
    EXPECT_GT(felt.sections.size(), 3u);
    EXPECT_EQ(felt.duration_s(), uneven.duration_s()) << i;
  }
}

TEST(TrueCyclogram, AStopOfOneCyclogramSparesTheOthers) {
  const std::string stop = "{type: missing_stop, start: 8 min, length: 1 min, in: other}";
  EXPECT_EQ(true_cyclogram(change_of(stop), kRecorded).sections, kRecorded.sections);
  EXPECT_THAT(speeds_rpm(true_cyclogram(change_of(stop, "other"), kRecorded)), ElementsAre(1000, 0, 1000, 3000, 0));
}

// An ambient that warms by 3 K in 20 min, during a cyclogram of 25 min.
const TimeSeries kAmbient{{0, 1200}, {1.0, 4.0}};

TEST(TrueAmbient, OffsetFromTheStartOnHoldsEverywhere) {
  const TimeSeries ambient = true_ambient(change_of("{type: ambient, offset: -2 K}"), kAmbient, kRecorded);
  EXPECT_DOUBLE_EQ(ambient.at(0), -1.0);
  EXPECT_DOUBLE_EQ(ambient.at(600), 0.5);
  EXPECT_DOUBLE_EQ(ambient.at(1500), 2.0);
}

TEST(TrueAmbient, StepTakesAMillisecondAndRampGoesOnToTheEnd) {
  const TimeSeries ambient =
      true_ambient(change_of("{type: ambient, offset: 2 K, ramp: 6 K/h, from: 5 min}"), kAmbient, kRecorded);
  EXPECT_DOUBLE_EQ(ambient.at(150), 1.375);              // untouched
  EXPECT_DOUBLE_EQ(ambient.at(300), 1.75);               // the last value before
  EXPECT_NEAR(ambient.at(300.001), 1.75 + 2.0, 1e-5);    // a millisecond of both slopes is 4 uK
  EXPECT_NEAR(ambient.at(900), 3.25 + 2.0 + 1.0, 1e-9);  // 10 min of 6 K/h: rounding of interpolation alone
  EXPECT_NEAR(ambient.at(1500), 4.0 + 2.0 + 2.0, 1e-9);  // beyond the ambient's own knots
}

TEST(TrueAmbient, MayBeAnotherOneForAWhile) {
  const TimeSeries ambient =
      true_ambient(change_of("{type: ambient, offset: 2 K, from: 5 min, until: 10 min}"), kAmbient, kRecorded);
  EXPECT_DOUBLE_EQ(ambient.at(300), 1.75);
  EXPECT_NEAR(ambient.at(300.001), 1.75 + 2.0, 1e-5);
  EXPECT_NEAR(ambient.at(450), 2.125 + 2.0, 1e-9);
  EXPECT_NEAR(ambient.at(600), 2.5 + 2.0, 1e-9);
  EXPECT_NEAR(ambient.at(600.001), 2.5, 1e-5);
  EXPECT_NEAR(ambient.at(900), 3.25, 1e-9);
  EXPECT_REFUSED(read("{type: ambient, offset: 2 K, from: 5 min, until: 4 min}"), "until");
}

TEST(TrueAmbient, ErrorsAddUp) {
  const DriveChange both =
      drive_change({read("{type: ambient, offset: 1 K}"), read("{type: ambient, offset: 2 K}")}, "shift");
  EXPECT_DOUBLE_EQ(true_ambient(both, kAmbient, kRecorded).at(600), 5.5);
}

TEST(TrueAmbient, AnErrorOfOneCyclogramSparesTheOthers) {
  EXPECT_EQ(true_ambient(change_of("{type: ambient, offset: 1 K, in: other}"), kAmbient, kRecorded).value, kAmbient.value);
  EXPECT_NE(true_ambient(change_of("{type: ambient, offset: 1 K, in: other}", "other"), kAmbient, kRecorded).value,
            kAmbient.value);
}

TEST(TrueAmbient, OfALateClockIsTheRecordAheadByAsMuch) {
  const TimeSeries ambient = true_ambient(change_of("{type: ambient, late: 5 min}"), kAmbient, kRecorded);
  EXPECT_DOUBLE_EQ(ambient.at(0), 1.75);
  EXPECT_DOUBLE_EQ(ambient.at(600), 3.25);
  EXPECT_DOUBLE_EQ(ambient.at(900), 4.0);  // recorded at 1200 s
  EXPECT_DOUBLE_EQ(ambient.at(1500), 4.0);
  const TimeSeries early = true_ambient(change_of("{type: ambient, late: -5 min}"), kAmbient, kRecorded);
  EXPECT_DOUBLE_EQ(early.at(0), 1.0);
  EXPECT_DOUBLE_EQ(early.at(300), 1.0);
  EXPECT_DOUBLE_EQ(early.at(900), 2.5);  // recorded at 600 s
}

TEST(TrueAmbient, OfASlowThermometerIsAheadOfTheRecordByItsLag) {
  // A wave of an hour that a thermometer of 4 min follows: smaller by cos(phi), later by phi, tan(phi) = lag omega. The
  // slope over half of a lag is 0.2 % short.
  const double omega_1_s = 2.0 * std::numbers::pi / 3600.0, phi = std::atan(240.0 * omega_1_s);
  TimeSeries recorded;
  for (double t_s = 0.0; t_s <= 7200.0; t_s += 10.0) {
    recorded.time_s.push_back(t_s);
    recorded.value.push_back(20.0 + 2.0 * std::cos(phi) * std::sin(omega_1_s * t_s - phi));
  }
  const Cyclogram two_hours{.name = "shift", .sections = {turning(7200, 1000)}};
  const TimeSeries ambient = true_ambient(change_of("{type: ambient, lag: 4 min}"), recorded, two_hours);
  double most_K = 0.0;
  for (double t_s = 120.0; t_s <= 7080.0; t_s += 10.0)
    most_K = std::max(most_K, std::abs(ambient.at(t_s) - (20.0 + 2.0 * std::sin(omega_1_s * t_s))));
  EXPECT_LT(most_K, 0.005);
}

TEST(TrueAmbient, OfASlowThermometerIsAheadAllTheWayBetweenRowsThatAreFarApart) {
  const TimeSeries recorded{{0, 3600, 7200}, {0.0, 2.0, 0.0}};  // 2 K/h up and down
  const Cyclogram two_hours{.name = "shift", .sections = {turning(7200, 1000)}};
  const TimeSeries ambient = true_ambient(change_of("{type: ambient, lag: 12 min}"), recorded, two_hours);
  for (const double t_s : {0.0, 600.0, 1800.0, 3400.0}) EXPECT_NEAR(ambient.at(t_s), t_s / 1800.0 + 0.4, 1e-12) << t_s;
  for (const double t_s : {3800.0, 5400.0, 7200.0}) EXPECT_NEAR(ambient.at(t_s), 4.0 - t_s / 1800.0 - 0.4, 1e-12) << t_s;
}

TEST(TrueAmbient, FollowsTheSpeedBehindALag) {
  const TimeSeries recorded{{0, 1500}, {1.0, 1.0}};
  const TimeSeries ambient =
      true_ambient(change_of("{type: ambient, with_speed: -2 K, at_speed: 2000 rpm, behind: 5 min}"), recorded, kRecorded);
  const auto expected = [](double t_s) {  // half of it at 1000 rpm, one and a half at 3000 rpm, nothing at rest
    const double first = 0.5 * -std::expm1(-std::min(t_s, 600.0) / 300.0);
    const double second = t_s > 600.0 ? 1.5 + (first - 1.5) * std::exp(-(std::min(t_s, 1200.0) - 600.0) / 300.0) : first;
    return 1.0 - 2.0 * (t_s > 1200.0 ? second * std::exp(-(t_s - 1200.0) / 300.0) : second);
  };
  for (double t_s = 0.0; t_s <= 1500.0; t_s += 7.0)
    EXPECT_NEAR(ambient.at(t_s), expected(t_s), 0.01 * 3.0) << t_s;  // 1 % of a change from 1000 to 3000 rpm and back
  EXPECT_NEAR(ambient.at(1200), expected(1200), 1e-9);
  EXPECT_NEAR(ambient.at(1500), expected(1500), 1e-9);
}

TEST(DrivenBefore, IsTheMeanDriveOfTheRecordAndARest) {
  const std::string warm = "{type: run_state, warmed_up: 40 min, rested: 10 min, in: shift}";
  const Cyclogram before = driven_before(change_of(warm), kRecorded);
  EXPECT_THAT(durations_s(before), ElementsAre(2400, 600));
  EXPECT_THAT(speeds_rpm(before), ElementsAre(1600, 0));  // 1000, 3000 and 0 rpm for 10, 10 and 5 min
  EXPECT_DOUBLE_EQ(before.sections[0].drive.feed_m_s[0], 0.1);
  EXPECT_DOUBLE_EQ(before.sections[0].drive.cutting_power_W, 50.0);
  EXPECT_EQ(before.sections[1].drive, Drive{});
  Cyclogram with_bed = kRecorded;
  with_bed.sections[0].drive.signals = {{"bed", 20.0}};
  with_bed.sections[1].drive.signals = {{"bed", 60.0}};
  with_bed.sections[2].drive.signals = {{"bed", 60.0}};
  const Cyclogram behind = driven_before(change_of(warm), with_bed);
  EXPECT_DOUBLE_EQ(behind.sections[0].drive.signals[0].value, 44.0);
  EXPECT_DOUBLE_EQ(behind.sections[1].drive.signals[0].value, 20.0);  // as where the record begins, and not 0 degC
  EXPECT_EQ(before.name, "");
  EXPECT_DOUBLE_EQ(before.clock_s, -3000.0);
  const Effect standby = read("{type: heat_source, node: a, power: 40 W, runs: while_spindle_turns, runs_on: 3 min}");
  const DriveChange both = drive_change({read(warm), standby}, "shift");
  const Cyclogram rests = driven_before(both, true_cyclogram(both, kRecorded));
  EXPECT_THAT(durations_s(rests), ElementsAre(2400, 180, 420));  // heat that continues after the stop does so for its time
  ASSERT_THAT(rests.sections[1].drive.signals, ::testing::SizeIs(1));
  EXPECT_EQ(rests.sections[1].drive.signals[0].value, 1600.0);
  EXPECT_EQ(rests.sections[2].drive.signals[0].value, 0.0);
  EXPECT_THAT(driven_before(change_of(warm, "other"), kRecorded).sections, ::testing::IsEmpty());
  EXPECT_THAT(driven_before(change_of("{type: run_state, factor: 2, in: shift}"), kRecorded).sections, ::testing::IsEmpty());
}

struct Bad {
  const char* text;
  const char* message;
};
class BadDriveEffect : public ::testing::TestWithParam<Bad> {};

TEST_P(BadDriveEffect, IsAnInputError) {
  EXPECT_REFUSED(read(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Each, BadDriveEffect,
    ::testing::Values(Bad{"{type: ambient}", "one of `offset`, `ramp`, `late`, `lag` and `with_speed`"},
                      Bad{"{type: ambient, late: 5 min, from: 1 h}", "hold all along"},
                      Bad{"{type: ambient, late: 5 min, behind: 5 min}", "only beside `with_speed`"},
                      Bad{"{type: ambient, lag: -1 min}", "outside what is allowed"},
                      Bad{"{type: ambient, ambient: ambient, offset: 1 K}", "unknown key 'ambient'"},
                      Bad{"{type: ambient, offset: 1 K/h}", "wrong unit"},
                      Bad{"{type: run_state, rested: 5 min, in: shift}", "only beside `warmed_up`"},
                      Bad{"{type: run_state, warmed_up: 5 min}", "`in` is required"},
                      Bad{"{type: run_state, in: shift}", "the entry changes nothing"},
                      Bad{"{type: speed_override}", "`factor` or `at_most` is required"},
                      Bad{"{type: speed_override, factor: -1}", "outside what is allowed"},
                      Bad{"{type: speed_override, factor: 2, every: 8 min, until_time: 1 h}", "has none"},
                      Bad{"{type: speed_override, factor: 2, windows: [[2 min, 1 min]]}", "must end after it begins"},
                      Bad{"{type: missing_stop, start: 1 min}", "key 'length' is missing"},
                      Bad{"{type: missing_stop, start: 1 min, length: 0 min}", "outside what is allowed"}));

}  // namespace
}  // namespace driftwright::effects::drive_effects_test
