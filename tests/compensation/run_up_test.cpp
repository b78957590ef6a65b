// A record that follows another, by hand.

#include "compensation/judging/run_up.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace driftwright::compensation::run_up_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A row a minute in [from, to).
Record minutes(const std::string& source, int from, int to) {
  Record r{.source = source, .time_s = {}, .channels = {{"speed", "rpm", {}}, {"bed", "degC", {}}, {"z", "um", {}}}};
  for (int i = from; i < to; ++i) {
    r.time_s.push_back(60.0 * i);
    for (std::size_t c = 0; c < 3; ++c) r.channels[c].values.push_back(100.0 * static_cast<double>(c) + i);
  }
  return r;
}

TEST(RunUp, IsTheRowsBeforeWithoutTheTarget) {
  const compensation::RunUp run =
      compensation::with_run_up(minutes("b", 3, 5), {minutes("x", 50, 60), minutes("a", 0, 3)}, "z");
  EXPECT_EQ(run.follows, "a");
  EXPECT_THAT(run.record.time_s, ElementsAre(0, 60, 120, 180, 240));
  EXPECT_THAT(run.record.at("bed").values, ElementsAre(100, 101, 102, 103, 104));
  const std::vector<double>& z = run.record.at("z").values;
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(std::isnan(z[i]));
  EXPECT_EQ(z[3], 203.0);
  EXPECT_EQ(z[4], 204.0);
}

TEST(RunUp, FindsItsChannelsInAnyOrderAndReachesTwelveHoursBack) {
  Record before = minutes("a", 0, 2000);
  std::swap(before.channels[0], before.channels[1]);
  const compensation::RunUp run = compensation::with_run_up(minutes("b", 2000, 2010), {before}, "z");
  EXPECT_EQ(run.record.time_s.front(), 60.0 * (2000 - 720));
  EXPECT_EQ(run.record.at("speed").values.front(), 1280.0);
  EXPECT_EQ(run.record.n_samples(), 730u);
}

TEST(RunUp, IsNotFoundWhereClocksOrChannelsDiffer) {
  const Record run = minutes("b", 30, 40);
  Record other_unit = minutes("a", 0, 30), one_less = other_unit;
  other_unit.channels[1].unit = "K";
  one_less.channels.pop_back();
  for (const Record& before :
       {minutes("long before", 0, 24), minutes("at the same time", 0, 31), minutes("later", 41, 50), other_unit, one_less}) {
    const compensation::RunUp alone = compensation::with_run_up(run, {before}, "z");
    EXPECT_THAT(alone.follows, IsEmpty()) << before.source;
    EXPECT_EQ(alone.record.time_s, run.time_s);
  }
  EXPECT_EQ(compensation::with_run_up(run, {minutes("a", 0, 26)}, "z").follows, "a");  // four rows are missing between them
}

}  // namespace
}  // namespace driftwright::compensation::run_up_test
