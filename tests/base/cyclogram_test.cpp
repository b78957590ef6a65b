#include "base/cyclogram.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/series_in_order.hpp"

namespace driftwright::cyclogram_test {
namespace {

const Cyclogram kCycle{.name = "c", .sections = {{100, 2000}, {50, 0}, {50, 0}, {200, 500}}};

TEST(Cyclogram, SpeedHoldsFromTheStartOfASectionOn) {
  EXPECT_EQ(kCycle.duration_s(), 400.0);
  EXPECT_EQ(kCycle.speed_rpm(0), 2000.0);
  EXPECT_EQ(kCycle.speed_rpm(99.999), 2000.0);
  EXPECT_EQ(kCycle.speed_rpm(100), 0.0);
  EXPECT_EQ(kCycle.speed_rpm(200), 500.0);
  EXPECT_EQ(kCycle.speed_rpm(400), 500.0);
  EXPECT_EQ(kCycle.speed_rpm(1e6), 500.0);
}

TEST(TimeSeries, IsLinearBetweenKnotsAndConstantOutside) {
  const TimeSeries s{{10, 20, 40}, {1, 3, -1}};
  EXPECT_EQ(s.at(0), 1.0);
  EXPECT_EQ(s.at(10), 1.0);
  EXPECT_DOUBLE_EQ(s.at(15), 2.0);
  EXPECT_DOUBLE_EQ(s.at(20), 3.0);
  EXPECT_DOUBLE_EQ(s.at(30), 1.0);
  EXPECT_EQ(s.at(41), -1.0);
}

TEST(SeriesInOrder, HasTheSameValuesWhicheverWayItIsAsked) {
  const TimeSeries s{{10, 20, 40, 41}, {1, 3, -1, 5}};
  SeriesInOrder in_order(s);
  for (double t_s : {-5.0, 10.0, 13.0, 13.0, 20.0, 39.0, 40.5, 60.0, 15.0, 41.0, 0.0, 40.0, 1e6})
    EXPECT_EQ(in_order.at(t_s), s.at(t_s)) << t_s;
  const TimeSeries constant{{0}, {2}}, none;
  EXPECT_EQ(SeriesInOrder(constant).at(-1.0), 2.0);
  EXPECT_EQ(SeriesInOrder(constant).at(7.0), 2.0);
  EXPECT_THROW((void)SeriesInOrder(none).at(0.0), std::logic_error);
}

TEST(Cyclogram, SplitAtFurtherTimesEndsAtTheSameTimeToTheLastBit) {
  const Cyclogram cycle{.name = "odd",
                        .sections = {{0.1, {.speed_rpm = 1}}, {1.0 / 3.0, {.speed_rpm = 2}}, {977.7, {.speed_rpm = 3}}},
                        .remarks = {},
                        .columns = {{"heater", "W", {{0, 5}, {1, 7}}}}};
  std::vector<double> times_s = {-1, 0, 0.1, 1e4, 0.05};
  for (int i = 0; i < 300; ++i) times_s.push_back(3.3 * i + 0.7);
  const Cyclogram split = split_at(cycle, times_s);
  EXPECT_EQ(split.sections.size(), 3u + 1u + 297u);  // 0.7 ... 977.5 lie in the last section
  EXPECT_EQ(split.duration_s(), cycle.duration_s());
  for (double t_s : {0.0, 0.07, 0.2, 0.5, 0.9, 977.0}) EXPECT_EQ(split.drive(t_s), cycle.drive(t_s)) << t_s;
  EXPECT_EQ(split_at(cycle, {}).sections, cycle.sections);
  EXPECT_EQ(split.column("heater_W")->at(4.9), 1.0);
  EXPECT_EQ(split.column("heater")->at(5.0), 7.0);
  EXPECT_EQ(split.column("heater_K"), nullptr);
}

TEST(LinearStretches, EndAtChangesOfSpeedAndAtKnotsOfTheAmbient) {
  // Knots at 0 and 100 coincide with starts of sections; 30 and 250 lie inside; 900 lies after the end.
  const auto stretches = linear_stretches(kCycle, TimeSeries{{0, 30, 100, 250, 900}, {0, 1, 2, 3, 4}});
  const std::vector<double> start = {0, 30, 100, 150, 200, 250}, end = {30, 100, 150, 200, 250, 400};
  const std::vector<double> speed = {2000, 2000, 0, 0, 500, 500};
  const std::vector<bool> changed = {true, false, true, false, true, false};
  ASSERT_EQ(stretches.size(), start.size());
  for (std::size_t i = 0; i < start.size(); ++i) {
    EXPECT_EQ(stretches[i].start_s, start[i]);
    EXPECT_EQ(stretches[i].end_s, end[i]);
    EXPECT_EQ(stretches[i].drive.speed_rpm, speed[i]);
    EXPECT_EQ(stretches[i].drive_changed, changed[i]) << "stretch " << i;
  }
}

TEST(LinearStretches, HaveNoEmptyPieces) {
  const Cyclogram cycle{.name = "", .sections = {{0, 300}, {10, 1000}, {0, 2000}, {10, 1000}}};
  const auto stretches = linear_stretches(cycle, TimeSeries{{0}, {0}});
  ASSERT_EQ(stretches.size(), 2u);
  EXPECT_TRUE(stretches[0].drive_changed);
  EXPECT_EQ(stretches[0].drive.speed_rpm, 1000.0);
  EXPECT_EQ(stretches[1].start_s, 10.0);
  EXPECT_FALSE(stretches[1].drive_changed);
}

TEST(LinearStretches, EndAtFurtherKnotsInAnyOrder) {
  const auto stretches = linear_stretches(kCycle, std::vector<double>{350, 20, 20, 100, -5, 400, 1e9});
  const std::vector<double> end = {20, 100, 150, 200, 350, 400};
  ASSERT_EQ(stretches.size(), end.size());
  for (std::size_t i = 0; i < end.size(); ++i) EXPECT_EQ(stretches[i].end_s, end[i]);
  EXPECT_FALSE(stretches[1].drive_changed);
  EXPECT_THROW((void)linear_stretches(kCycle, std::vector<double>{std::nan("")}), std::logic_error);
}

TEST(LinearStretches, AreNotMadeOfRounding) {
  // 0.1 + 0.1 + 0.1 is not 0.3 in double precision.
  const Cyclogram cycle{.name = "", .sections = {{0.1, 1000}, {0.1, 0}, {0.1, 1000}, {0.1, 0}}};
  const auto stretches = linear_stretches(cycle, std::vector<double>{0.3, 0.2 + 1e-12, 0.35});
  ASSERT_EQ(stretches.size(), 5u);
  EXPECT_EQ(stretches[4].start_s, 0.35);
}

TEST(LinearStretches, AChangeOfFeedOrCuttingPowerAloneIsAChangeOfDrive) {
  const Drive turning{.speed_rpm = 1000.0};
  Drive moving = turning, cutting = turning;
  moving.feed_m_s[2] = 0.1;
  cutting.cutting_power_W = 400.0;
  const Cyclogram cycle{.name = "", .sections = {{10, turning}, {10, moving}, {10, moving}, {10, turning}, {10, cutting}}};
  const auto stretches = linear_stretches(cycle, std::vector<double>{});
  const std::vector<bool> changed = {true, true, false, true, true};
  ASSERT_EQ(stretches.size(), changed.size());
  for (std::size_t i = 0; i < changed.size(); ++i) EXPECT_EQ(stretches[i].drive_changed, changed[i]) << "stretch " << i;
  EXPECT_EQ(stretches[1].drive, moving);
  EXPECT_EQ(cycle.drive(45.0), cutting);
}

// An ambient jumps within a millisecond, also where a section lasts for weeks.
TEST(LinearStretches, KeepBothKnotsOfAJumpInALongSection) {
  const Cyclogram weeks{.name = "weeks", .sections = {{20.0 * 86400.0, {.speed_rpm = 1000}}}};
  const auto stretches = linear_stretches(weeks, std::vector<double>{600000.0, 600000.001});
  ASSERT_EQ(stretches.size(), 3u);
  EXPECT_EQ(stretches[1].start_s, 600000.0);
  EXPECT_EQ(stretches[1].end_s, 600000.001);
}

}  // namespace
}  // namespace driftwright::cyclogram_test
