// The paper's method on a machine of one mode, where each of its rules is exact.

#include "compensation/predictors/assembled_curves.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "tests/compensation/record_of.hpp"

namespace driftwright::compensation::assembled_curves_test {
namespace {

using fixtures::message_of;
using ::testing::HasSubstr;

constexpr double kTau_s = 4000.0;
const TestChannels kChannels{{"drift", "back"}, {"um", "um"}};  // one grows, one shrinks

double steady_um(double rpm, Eigen::Index channel) {
  return (channel == 0 ? 0.02 : -0.005) * rpm;
}

double exact_um(const Cyclogram& cyclogram, double t_s, Eigen::Index channel) {
  double y = 0.0, start_s = 0.0;
  for (const auto& s : cyclogram.sections) {
    const double dt_s = std::min(s.duration_s, t_s - start_s);
    if (dt_s <= 0.0) break;
    const double level = steady_um(s.drive.speed_rpm, channel);
    y = level + (y - level) * std::exp(-dt_s / kTau_s);
    start_s += s.duration_s;
  }
  return y;
}

std::vector<double> every(double step_s, double end_s) {
  std::vector<double> time_s;
  for (int i = 0; step_s * i <= end_s; ++i) time_s.push_back(step_s * i);
  return time_s;
}

ThermalTest test_at(double rpm) {
  ThermalTest t{{"test", {{18000, {.speed_rpm = rpm}}, {18000, {}}}}, {{0.0}, {0.0}}, every(60, 36000), {}};
  t.readings.resize(2, static_cast<Eigen::Index>(t.time_s.size()));
  for (Eigen::Index c = 0; c < 2; ++c) {
    for (std::size_t i = 0; i < t.time_s.size(); ++i)
      t.readings(c, static_cast<Eigen::Index>(i)) = exact_um(t.cyclogram, t.time_s[i], c);
  }
  return t;
}

AssembledCurves curves() {
  return {{test_at(2000), test_at(500), test_at(1000)}, kChannels};  // any order
}

Cyclogram steps(const std::vector<std::pair<double, double>>& s_rpm) {
  Cyclogram c{"steps", {}};
  for (const auto& [duration_s, rpm] : s_rpm) c.sections.push_back({duration_s, {.speed_rpm = rpm}});
  return c;
}

/// Largest error over the peak; rows at 70 s fall between sections and between the columns of the tables.
double error_over_peak(const AssembledCurves& curves, const Cyclogram& cyclogram, Eigen::Index channel) {
  const std::vector<double> time_s = every(70, cyclogram.duration_s());
  const Eigen::MatrixXd y = curves.predict(cyclogram, time_s);
  double worst = 0.0, peak = 0.0;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    worst = std::max(worst, std::abs(y(channel, static_cast<Eigen::Index>(i)) - exact_um(cyclogram, time_s[i], channel)));
    peak = std::max(peak, std::abs(exact_um(cyclogram, time_s[i], channel)));
  }
  return worst / peak;
}

// Exact but for the fit of each test's own exponentials, whose prior leaves 0.01 %, and tables of 30 s: (30/4000)^2 / 8.
constexpr double kOfTheFit = 1e-3;

TEST(AssembledCurves, OfOneModeAreExactStepwiseUp) {
  const Cyclogram up = steps({{3000, 500}, {4000, 1000}, {9000, 2000}});
  ASSERT_EQ(type_of(up), CyclogramType::kStepwiseUp);
  for (Eigen::Index c : {0, 1}) EXPECT_LT(error_over_peak(curves(), up, c), kOfTheFit);
}

TEST(AssembledCurves, OfOneModeAreExactOnAndOff) {
  const Cyclogram on_off = steps({{1800, 2000}, {900, 0}, {1800, 2000}, {900, 0}, {1800, 2000}, {5000, 0}});
  ASSERT_EQ(type_of(on_off), CyclogramType::kIntermittent);
  for (Eigen::Index c : {0, 1}) EXPECT_LT(error_over_peak(curves(), on_off, c), kOfTheFit);
}

TEST(AssembledCurves, OfOneModeAreExactStepwiseDownByTheExtraRule) {
  const Cyclogram down = steps({{12000, 2000}, {5000, 1000}, {9000, 500}});
  ASSERT_EQ(type_of(down), CyclogramType::kStepwiseDown);
  for (Eigen::Index c : {0, 1}) EXPECT_LT(error_over_peak(curves(), down, c), kOfTheFit);
}

TEST(AssembledCurves, BetweenTestedSpeedsAreLinearInSpeed) {
  // as this machine is
  EXPECT_LT(error_over_peak(curves(), steps({{6000, 1500}, {6000, 0}}), 0), kOfTheFit);
}

TEST(AssembledCurves, CoolOnFromALevelAboveTheCurveOfTheSpeedJustRun) {
  // The cooling curve after 500 rpm starts at 10 um; 2000 rpm left 38.
  EXPECT_LT(error_over_peak(curves(), steps({{12000, 2000}, {600, 500}, {9000, 0}}), 0), kOfTheFit);
}

TEST(AssembledCurves, StandAtZeroUntilTheSpindleHasTurned) {
  const Eigen::MatrixXd y = curves().predict(steps({{600, 0}, {600, 1000}}), {0.0, 300.0, 599.0});
  EXPECT_EQ(y.cwiseAbs().maxCoeff(), 0.0);
}

TEST(CyclogramType, IsRecognised) {
  EXPECT_EQ(type_of(steps({{60, 800}})), CyclogramType::kContinuous);
  EXPECT_EQ(type_of(steps({{60, 800}, {60, 800}})), CyclogramType::kContinuous);  // one speed in two sections
  EXPECT_EQ(type_of(steps({{60, 800}, {60, 1000}})), CyclogramType::kStepwiseUp);
  EXPECT_EQ(type_of(steps({{60, 800}, {60, 0}, {60, 800}})), CyclogramType::kIntermittent);
  EXPECT_EQ(type_of(steps({{60, 1000}, {60, 800}, {60, 800}, {60, 200}})), CyclogramType::kStepwiseDown);
  EXPECT_EQ(type_of(steps({{60, 1000}, {60, 800}, {60, 0}})), CyclogramType::kStepwiseDown);
  EXPECT_EQ(type_of(steps({{60, 1000}, {60, 0}, {60, 800}})), CyclogramType::kChaotic);
  EXPECT_EQ(type_of(steps({{60, 1000}, {60, 2000}, {60, 800}})), CyclogramType::kChaotic);
}

TEST(AssembledCurves, NameWhatIsWrong) {
  EXPECT_THAT(message_of([] { AssembledCurves({}, kChannels); }), HasSubstr("without tests"));
  EXPECT_THAT(message_of([] {
                AssembledCurves({test_at(500), test_at(500)}, kChannels);
              }),
              HasSubstr("two tests at 500 rpm"));
  ThermalTest hot = test_at(500);
  hot.cyclogram.sections.pop_back();
  EXPECT_THAT(message_of([&] { AssembledCurves({hot}, kChannels); }), HasSubstr("not heating at one speed and standstill"));
  const AssembledCurves c = curves();
  for (double rpm : {499.0, 2001.0}) {
    EXPECT_THAT(message_of([&] {
                  (void)c.predict(steps({{60, rpm}}), {0.0});
                }),
                HasSubstr("the tests ran at 500 to 2000 rpm"));
    EXPECT_EQ(message_of([&] { (void)c.predict(steps({{60, rpm}}), {0.0}, true); }), "no InputError");
  }
}

}  // namespace
}  // namespace driftwright::compensation::assembled_curves_test
