#include "studies/record_comparison.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "base/errors.hpp"

namespace driftwright::studies::record_comparison_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Record record(const std::string& source, std::vector<double> time_s, std::vector<Channel> channels) {
  return {.source = source, .time_s = std::move(time_s), .channels = std::move(channels)};
}

TEST(CompareRecords, SaysHowFarEachChannelIsApart) {
  const Record first = record("a", {0, 60, 120, 180},
                              {{"z", "um", {0, 2, 4, 6}}, {"t1", "degC", {20, 20, 20, 20}}, {"x", "um", {0, 0, 0, 0}}});
  // Every half minute; z is 1 more at 60 s and 3 less at 120 s; from 150 s on it has ended.
  const Record second = record(
      "b", {0, 30, 90, 150}, {{"z", "um", {0, 1.5, 4.5, -2.5}}, {"t1", "K", {20, 20, 20, 20}}, {"w", "rpm", {1, 1, 1, 1}}});
  const RecordComparison c = compare_records(first, second);
  ASSERT_EQ(c.channels.size(), 1u);
  const ChannelDifference& z = c.channels[0];
  EXPECT_EQ(z.name, "z");
  EXPECT_EQ(z.n_rows, 3);
  EXPECT_DOUBLE_EQ(z.largest, -3.0);  // at 120 s: 1 where the first has 4
  EXPECT_EQ(z.largest_at_s, 120.0);
  EXPECT_DOUBLE_EQ(z.at_end, -3.0);
  EXPECT_NEAR(z.rms, std::sqrt((0.0 + 1.0 + 9.0) / 3.0), 1e-12);
  EXPECT_DOUBLE_EQ(z.range, 4.0);
  EXPECT_THAT(c.only_first, ElementsAre("t1_degC", "x_um"));
  EXPECT_THAT(c.only_second, ElementsAre("t1_K", "w_rpm"));
  EXPECT_TRUE(std::isnan(c.second_at_rows.channels[0].values[3]));
}

TEST(CompareRecords, ThatShareNothingAreRefused) {
  const Record a = record("a", {0, 60}, {{"z", "um", {0, 1}}});
  EXPECT_THAT(
      [&] {
        (void)compare_records(a, record("b", {0, 60}, {{"z", "urad", {0, 1}}}));
      },
      ThrowsMessage<InputError>(HasSubstr("no channel of the same name and unit")));
  EXPECT_THAT(
      [&] {
        (void)compare_records(a, record("b", {100, 160}, {{"z", "um", {0, 1}}}));
      },
      ThrowsMessage<InputError>(HasSubstr("no stretch of time")));
}

}  // namespace
}  // namespace driftwright::studies::record_comparison_test
