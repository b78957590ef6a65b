#include "studies/record_comparison.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "base/errors.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::studies::record_comparison_test {
namespace {

using ::testing::ElementsAre;

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

TEST(CompareRecords, SayInHowManyRowsOneIsWithinTheBandOfTheOther) {
  const Record simulated = record("model", {0, 60, 120, 180}, {{"z", "um", {0, 2, 4, 6}}, {"t", "degC", {20, 20, 20, 20}}});
  const Record measured =
      record("machine", {0, 60, 120, 180}, {{"z", "um", {0, 2.4, 4.9, 5.8}}, {"t", "degC", {20, 21, 22, 23}}});
  // At rows of its own: the limits of z are linear between them, 0.25 per minute to either side.
  const RecordBand band{.limits = record("model", {0, 180}, {{"z_low", "um", {0, 5.25}}, {"z_high", "um", {0, 6.75}}}),
                        .words = "what is known"};
  const RecordComparison c = compare_records(simulated, measured, band);
  EXPECT_DOUBLE_EQ(c.channels[0].within_band.value(), 0.5) << "0 and 5.8; 2.4 and 4.9 are above 2.25 and 4.5";
  EXPECT_FALSE(c.channels[1].within_band) << "t has no band";
  EXPECT_DOUBLE_EQ(c.first_band->high("z")->values[2], 4.5);
  EXPECT_FALSE(c.second_band);
  const RecordComparison turned = compare_records(measured, simulated, std::nullopt, band);
  EXPECT_DOUBLE_EQ(turned.channels[0].within_band.value(), 0.5);
}

TEST(CompareRecords, ThatShareNothingAreRefused) {
  const Record a = record("a", {0, 60}, {{"z", "um", {0, 1}}});
  EXPECT_REFUSED(compare_records(a, record("b", {0, 60}, {{"z", "urad", {0, 1}}})), "no channel of the same name and unit");
  EXPECT_REFUSED(compare_records(a, record("b", {100, 160}, {{"z", "um", {0, 1}}})), "no stretch of time");
}

}  // namespace
}  // namespace driftwright::studies::record_comparison_test
