#include "compensation/judging/temperature_ambiguity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::compensation::temperature_ambiguity_test {
namespace {

Record curve(const std::string& source, std::vector<double> time_s, std::vector<double> t_C, std::vector<double> d_um) {
  return {.source = source,
          .time_s = std::move(time_s),
          .channels = {{"t", "degC", std::move(t_C)}, {"d", "um", std::move(d_um)}}};
}

std::optional<TemperatureAmbiguity> find(const std::vector<Record>& records, double floor_um = 5.0) {
  return temperature_ambiguity(records, "t", "d", floor_um);
}

// theta = T - 20 degC: d1 = 10, d2 = 10 + 3 theta on theta in [0, 5]. Spread 0.3 theta, largest at the end:
// 15/10.
TEST(TemperatureAmbiguity, FindsTheTemperatureOfTheLargestSpread) {
  const auto worst = find({curve("slow", {0, 100}, {20, 25}, {10, 10}), curve("fast", {0, 50}, {20, 25}, {10, 25})});
  ASSERT_TRUE(worst);
  EXPECT_DOUBLE_EQ(worst->temperature, 25.0);
  EXPECT_DOUBLE_EQ(worst->spread, 1.5);
  EXPECT_EQ(worst->first.source, "slow");
  EXPECT_DOUBLE_EQ(worst->first.displacement_um, 10.0);
  EXPECT_DOUBLE_EQ(worst->first.time_s, 100.0);
  EXPECT_EQ(worst->second.source, "fast");
  EXPECT_DOUBLE_EQ(worst->second.displacement_um, 25.0);
  EXPECT_DOUBLE_EQ(worst->second.time_s, 50.0);
}

// d1 = 2 theta, d2 = 2 theta + 10: spread 10 / (2 theta) grows without bound towards theta = 0. The floor of
// 5 um stops it at theta = 2.5, between the only two samples: d = 5 and 15, spread 2, halfway in time. Both
// signs alike.
TEST(TemperatureAmbiguity, StopsExactlyAtTheFloor) {
  for (double sign : {1.0, -1.0}) {
    const auto worst =
        find({curve("a", {0, 100}, {20, 25}, {0, sign * 10}), curve("b", {0, 60}, {20, 25}, {sign * 10, sign * 20})});
    ASSERT_TRUE(worst);
    EXPECT_NEAR(worst->temperature, 22.5, 1e-12);
    EXPECT_NEAR(worst->spread, 2.0, 1e-12);
    EXPECT_NEAR(worst->first.displacement_um, sign * 5.0, 1e-12);
    EXPECT_NEAR(worst->first.time_s, 50.0, 1e-10);
    EXPECT_NEAR(worst->second.time_s, 30.0, 1e-10);
  }
}

// "b" crosses 22 degC three times, with d = 10 on the way up, 30 on the way down and 12 on the second way up;
// "a" is there once, with 12 um. Worst pair: 30 against 12, spread 18/12 = 1.5, at 15 s. "a" is so short that
// only 22 +- 0 counts.
TEST(TemperatureAmbiguity, WeighsEveryCrossing) {
  const auto worst =
      find({curve("a", {0, 1}, {22, 22}, {12, 12}), curve("b", {0, 10, 20, 30}, {20, 24, 20, 24}, {6, 14, 46, -22})});
  ASSERT_TRUE(worst);
  EXPECT_DOUBLE_EQ(worst->temperature, 22.0);
  EXPECT_NEAR(worst->second.displacement_um, 30.0, 1e-12);
  EXPECT_NEAR(worst->second.time_s, 15.0, 1e-12);
  EXPECT_NEAR(worst->spread, 1.5, 1e-12);
}

// +8 against -6 um: |8 + 6| / 6.
TEST(TemperatureAmbiguity, OppositeSignsSpreadByTheSum) {
  const auto worst = find({curve("a", {0, 1}, {20, 21}, {8, 8}), curve("b", {0, 1}, {20, 21}, {-6, -6})});
  ASSERT_TRUE(worst);
  EXPECT_NEAR(worst->spread, 14.0 / 6.0, 1e-12);
  EXPECT_EQ(worst->temperature, 20.0);  // of equal spreads the lowest temperature
}

// The analytic curves of a heating and a cooling body sampled finely: T = 20 + 5 (1 - e^-u), d = 40 (1 -
// e^(-u/3)), and cooling from the steady state T = 20 + 5 e^-u, d = 40 e^(-u/3). With theta = (T - 20)/5:
// d_heat = 40 (1 - (1 - theta)^(1/3)), d_cool = 40 theta^(1/3). The ratio d_cool/d_heat falls with theta, so
// the floor decides: d_heat = 5 at (1 - theta)^(1/3) = 7/8, theta = 1 - 343/512 = 169/512; d_cool = 40
// (169/512)^(1/3) = 5 * 169^(1/3).
TEST(TemperatureAmbiguity, AgreesWithTheClosedFormOfHeatingAndCooling) {
  Record heating = curve("heating", {}, {}, {});
  Record cooling = curve("cooling", {}, {}, {});
  for (int i = 0; i <= 6000; ++i) {
    const double u = 0.001 * i;
    heating.time_s.push_back(u);
    heating.channels[0].values.push_back(20.0 + 5.0 * (1.0 - std::exp(-u)));
    heating.channels[1].values.push_back(40.0 * (1.0 - std::exp(-u / 3.0)));
    cooling.time_s.push_back(u);
    cooling.channels[0].values.push_back(20.0 + 5.0 * std::exp(-u));
    cooling.channels[1].values.push_back(40.0 * std::exp(-u / 3.0));
  }
  const auto worst = find({heating, cooling});
  ASSERT_TRUE(worst);
  // Linear interpolation over du = 0.001 errs by du^2/8 d'' < 1e-6 um of 5.
  EXPECT_NEAR(worst->temperature, 20.0 + 5.0 * 169.0 / 512.0, 1e-5);
  EXPECT_NEAR(worst->spread, std::cbrt(169.0) - 1.0, 1e-5);
}

TEST(TemperatureAmbiguity, NeedsTwoRecordsAtOneTemperatureAboveTheFloor) {
  const Record hysteresis = curve("a", {0, 1, 2}, {20, 25, 20}, {10, 20, 40});
  EXPECT_FALSE(find({hysteresis}));                                           // one record alone proves nothing
  EXPECT_FALSE(find({hysteresis, curve("b", {0, 1}, {26, 28}, {10, 90})}));   // never as warm
  EXPECT_FALSE(find({hysteresis, curve("b", {0, 1}, {20, 25}, {0, 4.9})}));   // below the floor
  EXPECT_FALSE(find({hysteresis, curve("b", {0, 1}, {NAN, 22}, {10, 90})}));  // a gap
  EXPECT_FALSE(find({}));
}

TEST(TemperatureAmbiguity, RefusesBadInput) {
  const Record good = curve("a", {0, 1}, {20, 25}, {10, 20});
  Record in_mm = good, in_kelvin = good;
  in_mm.channels[1].unit = "mm";
  in_kelvin.channels[0].unit = "K";
  EXPECT_THROW((void)find({good}, 0.0), RangeError);
  EXPECT_THROW((void)find({good}, NAN), RangeError);
  EXPECT_REFUSED(find({in_mm}), "is in mm; it must be in um");
  EXPECT_REFUSED(find({good, in_kelvin}), "in degC in a but in K");
  EXPECT_THROW((void)temperature_ambiguity(std::vector{good}, "nowhere", "d"), InputError);
}

}  // namespace
}  // namespace driftwright::compensation::temperature_ambiguity_test
