// The figures of ISO 230-3 of a body that warms exponentially, d(t) = a (1 - exp(-t / tau)): closed form.

#include "compensation/judging/iso230_3.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace driftwright::compensation::iso230_3_test {
namespace {

using ::testing::HasSubstr;

constexpr double kRise_um = 40.0, kTau_min = 50.0;

double warming_um(double t_min) {
  return kRise_um * -std::expm1(-t_min / kTau_min);
}

/// Rows every `step_min`: the speed up to `stop_min`, then rest; one displacement in um, one tilt in urad.
Record test_of(double end_min, double step_min, double stop_min, const std::function<double(double)>& drift_um) {
  Record record{.source = "test", .time_s = {}, .channels = {{"speed", "rpm", {}}, {"z", "um", {}}, {"a", "urad", {}}}};
  for (int i = 0; i * step_min <= end_min * (1.0 + 1e-12); ++i) {
    const double t_min = i * step_min;
    record.time_s.push_back(60.0 * t_min);
    record.channels[0].values.push_back(t_min < stop_min * (1.0 - 1e-12) ? 3000.0 : 0.0);
    record.channels[1].values.push_back(7.0 + drift_um(t_min));  // wherever the gauge was set to zero
    record.channels[2].values.push_back(-2.0 * drift_um(t_min));
  }
  return record;
}

TEST(Iso230Figures, OfAnExponentialRiseAreItsClosedForm) {
  const Iso230Figures f = iso230_3_figures(test_of(240, 1, 240, warming_um));
  ASSERT_EQ(f.not_available, "");
  EXPECT_DOUBLE_EQ(f.running_period_s, 240 * 60.0);
  ASSERT_EQ(f.channels.size(), 2U);
  EXPECT_EQ(f.channels[0].name, "z");
  EXPECT_EQ(f.channels[0].unit, "um");
  EXPECT_NEAR(f.channels[0].range_first_60_min, warming_um(60), 1e-12);
  EXPECT_NEAR(f.channels[0].range_running, warming_um(240), 1e-12);
  EXPECT_NEAR(f.channels[0].at_end_of_running, warming_um(240), 1e-12);
  EXPECT_EQ(f.channels[1].name, "a");
  EXPECT_EQ(f.channels[1].unit, "urad");
  EXPECT_NEAR(f.channels[1].range_first_60_min, 2.0 * warming_um(60), 1e-12);
  EXPECT_NEAR(f.channels[1].at_end_of_running, -2.0 * warming_um(240), 1e-12) << "a value has a sign, a range has none";
}

// d rises to a at 30 min and falls to -a at 90 min as a sine does: a range is no end value.
TEST(Iso230Figures, TakeNoPositionOfAnAxisForADistortion) {
  Record record = test_of(240, 1, 240, warming_um);  // the spindle turns; no feed is recorded
  for (const char* name : {"position_x", "stroke_x", "nose"})
    record.channels.push_back({name, "mm", record.channels[1].values});
  const Iso230Figures f = iso230_3_figures(record);
  ASSERT_EQ(f.channels.size(), 3U);
  EXPECT_EQ(f.channels[2].name, "nose");
}

TEST(Iso230Figures, RangesAreOfTheCourseAndNotOfItsEnds) {
  const auto wave_um = [](double t_min) { return 10.0 * std::sin(2.0 * M_PI * t_min / 120.0); };
  const Iso230Channel z = iso230_3_figures(test_of(120, 1, 120, wave_um)).channels.front();
  EXPECT_NEAR(z.range_first_60_min, 10.0, 1e-9);
  EXPECT_NEAR(z.range_running, 20.0, 1e-9);
  EXPECT_NEAR(z.at_end_of_running, 0.0, 1e-9);
}

// The spindle stops at 100 min, and the nose shrinks below where it began until 200 min.
TEST(Iso230Figures, TheRunningPeriodEndsWhereTheSpindleStandsStillForGood) {
  const auto d_um = [](double t_min) { return t_min <= 100.0 ? 0.2 * t_min : 20.0 - 0.3 * (t_min - 100.0); };
  const Iso230Figures f = iso230_3_figures(test_of(200, 10, 100, d_um));
  EXPECT_DOUBLE_EQ(f.running_period_s, 6000.0);
  EXPECT_NEAR(f.channels[0].range_running, 20.0, 1e-12);
  EXPECT_NEAR(f.channels[0].at_end_of_running, 20.0, 1e-12);
  EXPECT_NEAR(f.channels[0].range_whole_record, 30.0, 1e-12);
  Record with_a_stop = test_of(200, 10, 100, d_um);
  with_a_stop.channels[0].values[3] = 0.0;
  EXPECT_DOUBLE_EQ(iso230_3_figures(with_a_stop).running_period_s, 6000.0) << "a stop within is part of the spectrum";
}

// Rows every 7 min: 60 min lies between two of them, where a straight line is exact.
TEST(Iso230Figures, TakeTheSixtiethMinuteBetweenRowsAndDoWithoutMissingReadings) {
  const auto line_um = [](double t_min) { return 0.1 * t_min; };
  Record record = test_of(84, 7, 84, line_um);
  record.channels[1].values[4] = std::numeric_limits<double>::quiet_NaN();
  const Iso230Channel z = iso230_3_figures(record).channels.front();
  EXPECT_NEAR(z.range_first_60_min, 6.0, 1e-12);
  EXPECT_NEAR(z.range_running, 8.4, 1e-12);
}

// The same of an axis that goes to and fro: errors at two places of its travel; its position in mm is no error.
TEST(Iso230Figures, OfAMovingAxisAreThoseOfEachPlace) {
  Record record = test_of(240, 1, 180, warming_um);
  const std::vector<double> feed = record.channels[0].values;
  record.channels = {{"speed", "rpm", std::vector<double>(feed.size(), 0.0)},
                     {"feed_x", "mm_min", feed},
                     {"position_x", "mm", std::vector<double>(feed.size(), 400.0)},
                     {"x_0", "um", record.channels[1].values},
                     {"x_800", "um", record.channels[2].values}};
  const Iso230Figures f = iso230_3_figures(record);
  ASSERT_EQ(f.not_available, "");
  EXPECT_EQ(f.test, Iso230Test::kLinearAxis);
  EXPECT_EQ(f.axes, "x");
  EXPECT_DOUBLE_EQ(f.running_period_s, 180 * 60.0);
  ASSERT_EQ(f.channels.size(), 2U);
  EXPECT_EQ(f.channels[0].name, "x_0");
  EXPECT_NEAR(f.channels[0].range_first_60_min, warming_um(60), 1e-12);
  EXPECT_NEAR(f.channels[1].at_end_of_running, -2.0 * warming_um(180), 1e-12);
  EXPECT_NEAR(f.channels[1].range_whole_record, 2.0 * warming_um(240), 1e-12);
  record.channels[0].values.assign(feed.size(), 500.0);
  EXPECT_EQ(iso230_3_figures(record).test, Iso230Test::kSpindle) << "a spindle that turns while axes move";
}

// A day of the ambient: +-6 um.
TEST(Iso230Figures, OfAMachineAtRestAreTheRangeOfTheWholeRecord) {
  const auto day_um = [](double t_min) { return 6.0 * std::sin(2.0 * M_PI * t_min / 1440.0); };
  const Iso230Figures f = iso230_3_figures(test_of(1440, 10, 0, day_um));
  ASSERT_EQ(f.not_available, "");
  EXPECT_EQ(f.test, Iso230Test::kAmbient);
  EXPECT_DOUBLE_EQ(f.running_period_s, 86400.0);
  EXPECT_NEAR(f.channels[0].range_whole_record, 12.0, 1e-9);
  EXPECT_NEAR(f.channels[1].range_whole_record, 24.0, 1e-9);
  EXPECT_TRUE(std::isnan(f.channels[0].range_running));
  EXPECT_THAT(iso230_3_figures(test_of(50, 10, 0, day_um)).not_available, HasSubstr("lasts for 50 min"));
}

TEST(Iso230Figures, SayWhatARecordLacks) {
  EXPECT_THAT(iso230_3_figures(test_of(45, 1, 45, warming_um)).not_available, HasSubstr("runs for 45 min"));
  EXPECT_THAT(iso230_3_figures(test_of(240, 1, 59, warming_um)).not_available, HasSubstr("runs for 59 min"));
  Record later = test_of(240, 1, 240, warming_um);
  later.channels[0].values[0] = 0.0;
  EXPECT_THAT(iso230_3_figures(later).not_available, HasSubstr("does not turn at the start"));
  later.channels[0] = {"feed_x", "mm_min", later.channels[0].values};
  EXPECT_THAT(iso230_3_figures(later).not_available, HasSubstr("no axis moves at the start"));
  Record no_speed = test_of(240, 1, 240, warming_um);
  no_speed.channels.erase(no_speed.channels.begin());
  EXPECT_THAT(iso230_3_figures(no_speed).not_available, HasSubstr("neither a spindle speed"));
  Record unread = test_of(240, 1, 0, warming_um);
  for (double& rpm : unread.channels[0].values) rpm = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(iso230_3_figures(unread).not_available, HasSubstr("neither a spindle speed"));
  Record no_drift = test_of(240, 1, 240, warming_um);
  no_drift.channels.resize(1);
  EXPECT_THAT(iso230_3_figures(no_drift).not_available, HasSubstr("no displacement"));
}

}  // namespace
}  // namespace driftwright::compensation::iso230_3_test
