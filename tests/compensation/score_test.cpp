#include "compensation/predictors/score.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::compensation::score_test {
namespace {

using ::testing::Each;
using ::testing::SizeIs;

TEST(Score, LeavesOutMissingValues) {
  const Score s = score(std::vector<double>{3, NAN, -4});
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(12.5));  // (9 + 16) / 2
  EXPECT_EQ(s.peak_abs, 4.0);
  EXPECT_EQ(s.mean, -0.5);
  EXPECT_EQ(s.n, 2);
}

TEST(Score, OfNothingIsNotANumberSoThatNoBoundHolds) {
  const Score s = score(std::vector<double>{NAN});
  EXPECT_EQ(s.n, 0);
  EXPECT_FALSE(s.rmse <= 1e300);
  EXPECT_FALSE(s.peak_abs <= 1e300);
}

// Two trainings: 2t on [0, 10] s and 10 + t on [0, 20] s.
const std::vector<Record> kTrain = {{.source = "a", .time_s = {0, 10}, .channels = {{"d", "um", {0, 20}}}},
                                    {.source = "b", .time_s = {0, 4, 20}, .channels = {{"d", "um", {10, 14, 30}}}}};
const Record kTest{.source = "c", .time_s = {-1, 5, 10, 15, 25}, .channels = {}};

TEST(Baselines, MeanIsThatOfAllTrainingSamples) {
  // (0 + 20 + 10 + 14 + 30) / 5 = 14.8
  const std::vector<double> predicted = baseline_mean(kTrain, kTest, "d");
  EXPECT_THAT(predicted, SizeIs(5));
  EXPECT_THAT(predicted, Each(::testing::DoubleEq(14.8)));
}

TEST(Baselines, LastIsTheLastValueOfTheLastRecordThatHasOne) {
  EXPECT_THAT(baseline_last(kTrain, kTest, "d"), Each(30.0));
  std::vector<Record> gaps = kTrain;
  gaps[1].channels[0].values = {10, 14, NAN};
  EXPECT_THAT(baseline_last(gaps, kTest, "d"), Each(14.0));
  gaps[1].channels[0].values = {NAN, NAN, NAN};
  EXPECT_THAT(baseline_last(gaps, kTest, "d"), Each(20.0));
  EXPECT_THAT(baseline_last(gaps, kTest, "d"), SizeIs(5));
}

TEST(Baselines, SameTimeAveragesTheRecordsThatReachIt) {
  const std::vector<double> predicted = baseline_same_time(kTrain, kTest, "d");
  EXPECT_TRUE(std::isnan(predicted[0]));
  EXPECT_DOUBLE_EQ(predicted[1], 12.5);  // (10 + 15) / 2
  EXPECT_DOUBLE_EQ(predicted[2], 20.0);  // (20 + 20) / 2
  EXPECT_DOUBLE_EQ(predicted[3], 25.0);  // the second alone
  EXPECT_TRUE(std::isnan(predicted[4]));
}

TEST(Baselines, RefuseTrainingWithoutData) {
  const std::vector<Record> empty = {{.source = "a", .time_s = {0, 1}, .channels = {{"d", "um", {NAN, NAN}}}}};
  EXPECT_REFUSED(baseline_mean(empty, kTest, "d"), "no value");
  EXPECT_THROW((void)baseline_mean({}, kTest, "d"), InputError);
  EXPECT_REFUSED(baseline_last(empty, kTest, "d"), "no value");
  EXPECT_THROW((void)baseline_last({}, kTest, "d"), InputError);
  EXPECT_THROW((void)baseline_same_time({}, kTest, "d"), InputError);
  EXPECT_THROW((void)baseline_same_time(kTrain, kTest, "nowhere"), InputError);
}

}  // namespace
}  // namespace driftwright::compensation::score_test
