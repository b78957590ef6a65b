// Thermometers that depart from what the others say of them.

#include "compensation/sensors/redundancy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/random.hpp"

namespace driftwright::compensation::redundancy_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::vector<std::string> kNames = {"t1", "t2", "t3", "t4", "t5", "t6"};

/// Six thermometers of a machine with two states: a body that warms with the speed, and the air. Noise of 0.02 K.
Record day(int which, double speed_rpm) {
  Record r{.source = "day " + std::to_string(which), .time_s = {}, .channels = {}};
  for (const std::string& name : kNames) r.channels.push_back({name, "degC", {}});
  r.channels.push_back({"speed", "rpm", {}});
  Random random(7, static_cast<std::uint64_t>(which));
  for (int i = 0; i < 300; ++i) {
    r.time_s.push_back(60.0 * i);
    const double body = speed_rpm / 500.0 * (1.0 - std::exp(-i / 60.0)), air = 20.0 + which + std::sin(i / 90.0);
    for (std::size_t k = 0; k < kNames.size(); ++k) {
      const double share = static_cast<double>(k) / 5.0;
      r.channels[k].values.push_back(air + share * body + 0.02 * random.normal());
    }
    r.channels.back().values.push_back(speed_rpm);
  }
  return r;
}

std::vector<Record> week() {
  std::vector<Record> days;
  for (int d = 0; d < 5; ++d) days.push_back(day(d, 1000.0 + 700.0 * d));
  return days;
}

void add(Record& record, const std::string& channel, int from_row, int to_row, double more_K) {
  std::vector<double>& x = record.channels[static_cast<std::size_t>(&record.at(channel) - record.channels.data())].values;
  for (int i = from_row; i < to_row; ++i) x[static_cast<std::size_t>(i)] += more_K;
}

std::vector<std::string> names(const std::vector<DoubtedThermometer>& doubted) {
  std::vector<std::string> result;
  for (const DoubtedThermometer& d : doubted) result.push_back(d.name);
  return result;
}

TEST(Redundancy, DoubtsNothingInADayThatIsFasterAndWarmerThanTheOthers) {
  EXPECT_THAT(doubted_thermometers(week(), kNames, {"speed"}, 0.1), IsEmpty());
}

TEST(Redundancy, SaysWhichThermometerBrokeAndWhen) {
  std::vector<Record> days = week();
  add(days[3], "t2", 134, 300, 30.0);  // and stays wrong
  add(days[4], "t2", 0, 300, 30.0);
  const std::vector<DoubtedThermometer> doubted = doubted_thermometers(days, kNames, {"speed"}, 0.1);
  ASSERT_THAT(names(doubted), ElementsAre("t2"));
  EXPECT_TRUE(doubted.front().is_alone);
  EXPECT_NEAR(doubted.front().off_K, 30.0, 1.0);
  EXPECT_LT(doubted.front().usual_K, 1.0);
}

TEST(Redundancy, TakesNoShortDisturbanceForAFault) {
  std::vector<Record> days = week();
  add(days[1], "t4", 100, 109, 5.0);  // nine minutes
  EXPECT_THAT(doubted_thermometers(days, kNames, {"speed"}, 0.1), IsEmpty());
  add(days[1], "t4", 109, 112, 5.0);  // twelve
  const std::vector<DoubtedThermometer> doubted = doubted_thermometers(days, kNames, {"speed"}, 0.1);
  ASSERT_THAT(names(doubted), ElementsAre("t4"));
  EXPECT_EQ(doubted.front().record, "day 1");
  EXPECT_NEAR(doubted.front().from_s, 6000.0, 1.0);
}

TEST(Redundancy, FindsAFaultInASingleRecord) {
  Record one = day(0, 3000.0);
  add(one, "t5", 200, 240, 12.0);
  EXPECT_THAT(names(doubted_thermometers(std::vector{one}, kNames, {"speed"}, 0.1)), ElementsAre("t5"));
}

TEST(Redundancy, SaysNothingOfThreeRecordsWhichCannotOutvoteOne) {
  std::vector<Record> days = week();
  add(days[3], "t2", 100, 300, 30.0);
  EXPECT_THAT(names(doubted_thermometers(days, kNames, {"speed"}, 0.1)), ElementsAre("t2"));
  days.erase(days.begin(), days.begin() + 2);
  EXPECT_THAT(doubted_thermometers(days, kNames, {"speed"}, 0.1), IsEmpty());
}

TEST(Redundancy, SaysNothingWhereNoRowHasAllReadings) {
  std::vector<Record> days = week();
  add(days[3], "t2", 100, 300, 30.0);
  for (Record& day : days) add(day, "speed", 0, 300, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(doubted_thermometers(days, kNames, {"speed"}, 0.1), IsEmpty());
}

TEST(Redundancy, BlamesNoneIfMoreThanAThirdDepart) {
  std::vector<Record> days = week();
  add(days[2], "t1", 100, 200, 8.0);
  add(days[2], "t3", 100, 200, -8.0);
  const std::vector<DoubtedThermometer> two = doubted_thermometers(days, kNames, {"speed"}, 0.1);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_FALSE(two.front().is_alone);  // in one record: perhaps one cause
  add(days[2], "t6", 100, 200, 16.0);
  EXPECT_THAT(doubted_thermometers(days, kNames, {"speed"}, 0.1), IsEmpty());
}

TEST(Redundancy, IsNotFinerThanAThermometerReads) {
  std::vector<Record> days = week();
  add(days[1], "t4", 100, 150, 3.0);
  EXPECT_THAT(names(doubted_thermometers(days, kNames, {"speed"}, 0.1)), ElementsAre("t4"));
  EXPECT_THAT(doubted_thermometers(days, kNames, {"speed"}, 1.0), IsEmpty());
}

}  // namespace
}  // namespace driftwright::compensation::redundancy_test
