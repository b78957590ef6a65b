#include "compensation/sensors/thermometers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "compensation/predictors/score.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::compensation::thermometers_test {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::NanSensitiveDoubleEq;

Record four_rows() {
  return {.source = "four",
          .time_s = {0, 10, 20, 30},
          .channels = {{"speed", "rpm", {0, 1000, 1000, 0}},
                       {"a", "degC", {20.0, 21.04, NAN, 23.06}},
                       {"b", "degC", {20.0, 20.0, 20.5, 20.5}},
                       {"drift", "um", {0.0, 1.23, 2.34, 3.45}}}};
}

TEST(Thermometers, RoundTemperaturesAndNothingElse) {
  const Record r = as_read(four_rows(), {.resolution_K = 0.1}, 1);
  EXPECT_THAT(r.at("a").values, ElementsAre(20.0, 21.0, NanSensitiveDoubleEq(NAN), DoubleNear(23.1, 1e-12)));
  EXPECT_EQ(r.at("drift").values, four_rows().at("drift").values);
}

// Rows every 10 s; a window of 10 s holds a reading and the one before.
TEST(Thermometers, RunningMeanLooksBackAndLeavesOutWhatIsMissing) {
  const Record r = running_mean(four_rows(), 10.0);
  EXPECT_THAT(r.at("a").values,
              ElementsAre(20.0, DoubleNear(20.52, 1e-12), DoubleNear(21.04, 1e-12), DoubleNear(23.06, 1e-12)));
  EXPECT_THAT(r.at("b").values, ElementsAre(20.0, 20.0, 20.25, 20.5));
  EXPECT_EQ(r.at("drift").values, four_rows().at("drift").values);
  EXPECT_EQ(running_mean(four_rows(), 0.0).at("b").values, four_rows().at("b").values);
}

TEST(Thermometers, NoiseHasTheDeviationAskedForAndIsEachSensorsOwn) {
  Record r{.source = "still", .time_s = {}, .channels = {{"a", "degC", {}}, {"b", "K", {}}}};
  for (int i = 0; i < 20000; ++i) {
    r.time_s.push_back(i);
    for (Channel& c : r.channels) c.values.push_back(0.0);
  }
  const Record noisy = as_read(r, {.noise_K = 0.1}, 7);
  double product = 0.0;
  for (int i = 0; i < 20000; ++i) product += noisy.at("a").values[i] * noisy.at("b").values[i] / 20000;
  EXPECT_NEAR(score(noisy.at("a").values).rmse, 0.1, 5 * 0.1 / std::sqrt(2.0 * 20000));  // five standard errors
  EXPECT_NEAR(product, 0.0, 5 * 0.01 / std::sqrt(20000.0));
  EXPECT_EQ(noisy.at("a").values, as_read(r, {.noise_K = 0.1}, 7).at("a").values);
  EXPECT_NE(noisy.at("a").values, as_read(r, {.noise_K = 0.1}, 8).at("a").values);
}

TEST(Thermometers, FailAsTheyAreTold) {
  const Record r = four_rows();
  EXPECT_THAT(with_failed_sensor(r, "a", SensorFailure::kStuck, 20.0).at("a").values,
              ElementsAre(20.0, 21.04, 21.04, 21.04));
  EXPECT_THAT(with_failed_sensor(r, "b", SensorFailure::kOpen, 15.0).at("b").values,
              ElementsAre(20.0, 20.0, NanSensitiveDoubleEq(NAN), NanSensitiveDoubleEq(NAN)));
  EXPECT_THAT(with_failed_sensor(r, "b", SensorFailure::kDetached, 30.0, "a").at("b").values,
              ElementsAre(20.0, 20.0, 20.5, 23.06));
  const Record swapped = with_failed_sensor(r, "b", SensorFailure::kSwapped, 30.0, "a");
  const Record rising = with_failed_sensor(r, "b", SensorFailure::kRising, 20.0),
               falling = with_failed_sensor(r, "b", SensorFailure::kFalling, 20.0);
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  for (std::size_t i = 0; i < r.n_samples(); ++i) {
    const bool is_after = r.time_s[i] >= 30.0;
    EXPECT_TRUE(same(swapped.at("a").values[i], r.at(is_after ? "b" : "a").values[i])) << i;
    EXPECT_TRUE(same(swapped.at("b").values[i], r.at(is_after ? "a" : "b").values[i])) << i;
    if (std::isnan(r.at("b").values[i])) continue;
    const double drift_K = 2.0 / 3600.0 * std::max(0.0, r.time_s[i] - 20.0);
    EXPECT_NEAR(rising.at("b").values[i], r.at("b").values[i] + drift_K, 1e-12);
    EXPECT_NEAR(falling.at("b").values[i], r.at("b").values[i] - drift_K, 1e-12);
  }
  EXPECT_REFUSED(with_failed_sensor(r, "b", SensorFailure::kDetached, 0.0, "drift"),
                 "'b' in degC cannot read 'drift' in um");
}

TEST(Sampling, IsLinearBetweenRowsAndHoldsTheSpeed) {
  const Record r = sampled(four_rows(), 4.0);
  EXPECT_THAT(r.time_s, ElementsAre(0, 4, 8, 12, 16, 20, 24, 28));
  EXPECT_THAT(r.at("speed").values, ElementsAre(0, 0, 0, 1000, 1000, 1000, 1000, 1000));
  EXPECT_NEAR(r.at("drift").values[1], 0.4 * 1.23, 1e-12);
  EXPECT_TRUE(std::isnan(r.at("a").values[4]));
  EXPECT_EQ(sampled(four_rows(), 10.0).at("drift").values, four_rows().at("drift").values);
  EXPECT_THROW((void)sampled(four_rows(), 0.0), RangeError);
}

}  // namespace
}  // namespace driftwright::compensation::thermometers_test
