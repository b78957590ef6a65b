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

scenarios::Variation varied(const std::string& name, scenarios::Spread spread) {
  scenarios::Variation v;
  v.name = name;
  v.unit = "N";
  v.is_number = true;
  v.spread = spread;
  return v;
}

TEST(Tornado, OfALinearResultIsItsSlopesTimesTheRanges) {
  using Kind = scenarios::Spread::Kind;
  scenarios::SweepPlan plan;
  plan.variations = {varied("small", {Kind::kUniform, 0.0, 1.0}), varied("large", {Kind::kNormal, 5.0, 2.0}),
                     varied("flow", {Kind::kLogUniform, 1.0, 100.0})};
  plan.collect.resize(1);
  SweepColumns columns;
  columns.varied.resize(3);
  columns.results.resize(1);
  for (int i = 0; i < 30; ++i) {
    const double a = (7 * i % 30) / 30.0, b = 5.0 + std::sin(i), c = std::exp(i % 5);
    columns.varied[0].push_back(a);
    columns.varied[1].push_back(b);
    columns.varied[2].push_back(c);
    columns.results[0].push_back(i == 4 ? std::nan("") : 100.0 + 2.0 * a - 3.0 * b + 0.5 * std::log(c));
  }
  const auto tornado = tornado_of(plan, columns, 0);
  ASSERT_TRUE(tornado);
  EXPECT_NEAR(tornado->explained, 1.0, 1e-12);
  ASSERT_EQ(tornado->bars.size(), 3u);
  EXPECT_EQ(tornado->bars[0].variation, 1u) << "the longest first";
  EXPECT_EQ(tornado->bars[1].variation, 2u);
  const double range_of_normal = 2.0 * 1.959964 * 2.0;
  EXPECT_NEAR(tornado->bars[0].at_high - tornado->bars[0].at_low, -3.0 * range_of_normal, 1e-5);
  EXPECT_NEAR(tornado->bars[1].at_high - tornado->bars[1].at_low, 0.5 * 0.95 * std::log(100.0), 1e-9);
  EXPECT_NEAR(tornado->bars[2].at_high - tornado->bars[2].at_low, 2.0 * 0.95, 1e-9);
  EXPECT_NEAR(tornado->bars[2].low, 0.025, 1e-12);
}

TEST(Tornado, IsNoneWhereTheMembersDoNotTellTheNumbersApart) {
  scenarios::SweepPlan plan;
  plan.variations = {varied("a", {}), varied("b", {})};
  plan.collect.resize(1);
  SweepColumns columns;
  columns.varied = {{1, 2, 3, 4, 5, 6, 7}, {2, 4, 6, 8, 10, 12, 14}};
  columns.results = {{1, 2, 3, 4, 5, 6, 7}};
  EXPECT_FALSE(tornado_of(plan, columns, 0)) << "two numbers that always change together";
  columns.varied[1] = {2, 2, 2, 2, 2, 2, 2};
  EXPECT_FALSE(tornado_of(plan, columns, 0)) << "a number that does not change";
  columns.varied[1] = {3, 1, 4, 1, 5, 9, 2};
  EXPECT_TRUE(tornado_of(plan, columns, 0));
  columns.results[0] = {4, 4, 4, 4, 4, 4, 4};
  EXPECT_FALSE(tornado_of(plan, columns, 0)) << "a constant result";
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
