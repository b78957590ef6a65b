// Scalars of a channel and statistics of a table.

#include "studies/sweep_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "studies/sweep_member.hpp"
#include "studies/sweep_run.hpp"

namespace driftwright::studies::sweep_statistics_test {
namespace {

using scenarios::Scalar;

TEST(ScalarOf, PeakIsFarthestFromNeutralWithItsSign) {
  const Channel channel{"a", "um", {0.0, 3.0, -5.0, 5.0, 1.0}};
  const Record record{"", {0, 10, 20, 30, 40}, {channel}};
  EXPECT_EQ(scalar_of(record, channel, Scalar::kPeak, 0.0), -5.0) << "the first of equals";
  EXPECT_EQ(scalar_of(record, channel, Scalar::kTimeOfPeak, 0.0), 20.0);
  EXPECT_EQ(scalar_of(record, channel, Scalar::kPeak, -4.0), 5.0);
  EXPECT_EQ(scalar_of(record, channel, Scalar::kTimeOfPeak, -4.0), 30.0);
  EXPECT_EQ(scalar_of(record, channel, Scalar::kEnd, 0.0), 1.0);
  EXPECT_EQ(scalar_of(record, channel, Scalar::kMin, 0.0), -5.0);
  EXPECT_EQ(scalar_of(record, channel, Scalar::kMax, 0.0), 5.0);
}

TEST(RankCorrelation, LooksAtOrderAlone) {
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {1, 10, 100, 1000}), 1.0);
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3}, {3, 2, -7}), -1.0);
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {2, 1, 4, 3}), 0.6);  // 1 - 6 Σ d² / (n (n² - 1)) = 1 - 24/60
  EXPECT_DOUBLE_EQ(rank_correlation({1, 1, 2}, {1, 2, 3}), 1.5 / std::sqrt(1.5 * 2.0));  // ranks 1.5, 1.5, 3
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 9}, {1, 2, std::nan("")}), 1.0) << "pairs without NaN";
  EXPECT_TRUE(std::isnan(rank_correlation({1, 1}, {1, 2})));
}

TEST(TableRow, SaysWhyAMemberFailedOnOneLine) {
  scenarios::SweepPlan plan;
  plan.collect.resize(2);
  const std::string good = table_row(plan, {.member = 4, .results = {1.25, -1.0 / 3}, .failure = "", .is_refused = false});
  EXPECT_EQ(good, "5,1.25,-0.3333333,done");
  EXPECT_TRUE(is_done(good));
  const std::string bad =
      table_row(plan, {.member = 0, .results = {}, .failure = "no, done\n  excerpt", .is_refused = true});
  EXPECT_EQ(bad, "1,,,\"refused: no, done\"");
  EXPECT_FALSE(is_done(bad));
}

}  // namespace
}  // namespace driftwright::studies::sweep_statistics_test
