// Residuals made by hand, and what is said of them.

#include "diagnosis/residual_structure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace driftwright::diagnosis::residual_structure_test {
namespace {

/// Eight hours, a row a minute, the speed changing every 40 min, an ambient that swings once in five hours.
MeasuredRun run() {
  MeasuredRun r;
  for (int i = 0; i <= 480; ++i) r.time_s.push_back(60.0 * i);
  for (double rpm : {1000.0, 0.0, 3000.0, 2000.0, 0.0, 500.0, 3000.0, 0.0, 1500.0, 2500.0, 0.0, 1000.0})
    r.cyclogram.sections.push_back({2400.0, {.speed_rpm = rpm}});
  for (double t_s : r.time_s) {
    r.ambient.time_s.push_back(t_s);
    r.ambient.value.push_back(std::sin(2.0 * std::numbers::pi * t_s / 18000.0));
  }
  return r;
}

Eigen::VectorXd series(const MeasuredRun& r, const std::function<double(double)>& of_time) {
  Eigen::VectorXd s(static_cast<Eigen::Index>(r.time_s.size()));
  for (Eigen::Index i = 0; i < s.size(); ++i) s[i] = of_time(r.time_s[static_cast<std::size_t>(i)]);
  return s;
}
double likeness(const ResidualStructure& s, const std::string& quantity, std::size_t lag) {
  for (const auto& l : s.likenesses) {
    if (l.quantity == quantity) return l.correlation[lag];
  }
  return NAN;
}

TEST(ResidualStructure, OfWhiteNoiseIsNothing) {
  const MeasuredRun r = run();
  std::mt19937 generator(7);
  std::normal_distribution<double> normal(0.0, 0.5);
  const ResidualStructure s = residual_structure(r, series(r, [&](double) { return normal(generator); }));
  EXPECT_NEAR(s.rms, 0.5, 0.05);  // 481 values: 3 % of one sigma
  EXPECT_NEAR(s.white_up_to, 1.96 / std::sqrt(481.0), 1e-12);
  EXPECT_LT(std::abs(s.lag_1), 2.0 * s.white_up_to);
  EXPECT_FALSE(s.lag);
}

TEST(ResidualStructure, LagOneOfASlowSeriesIsNearOneAndOfAnAlternatingOneMinusOne) {
  const MeasuredRun r = run();
  EXPECT_GT(residual_structure(r, series(r, [](double t_s) { return std::cos(t_s / 9000.0); })).lag_1, 0.99);
  EXPECT_LT(residual_structure(r, series(r, [](double t_s) { return std::fmod(t_s, 120.0) - 30.0; })).lag_1, -0.99);
}

TEST(ResidualStructure, FindsHowLongAgoTheSpeedWas) {
  const MeasuredRun r = run();
  const auto late = [&](double by_s) {
    return residual_structure(
        r, series(r, [&](double t_s) { return t_s >= by_s ? 1e-3 * r.cyclogram.drive(t_s - by_s).speed_rpm - 2.0 : NAN; }));
  };
  for (std::size_t lag = 0; lag < kLags_s.size(); ++lag) {
    const ResidualStructure s = late(kLags_s[lag]);
    for (std::size_t other = 0; other < kLags_s.size(); ++other) {
      if (other == lag) {
        EXPECT_NEAR(likeness(s, "speed", other), 1.0, 1e-9);
      } else {
        EXPECT_LT(likeness(s, "speed", other), 0.97);
      }
    }
  }
}

TEST(ResidualStructure, TellsSpeedFromItsSquareItsChangesAndTheAmbient) {
  const MeasuredRun r = run();
  const auto square =
      residual_structure(r, series(r, [&](double t_s) { return std::pow(r.cyclogram.drive(t_s).speed_rpm, 2); }));
  EXPECT_NEAR(likeness(square, "speed^2", 0), 1.0, 1e-9);
  EXPECT_LT(likeness(square, "speed", 0), 0.99);
  const auto changes =
      residual_structure(r, series(r, [&](double t_s) {
                           return std::abs(r.cyclogram.drive(t_s).speed_rpm - r.cyclogram.drive(t_s - 60.0).speed_rpm);
                         }));
  EXPECT_GT(likeness(changes, "|change of speed|", 0), 0.99);
  const auto ambient = residual_structure(r, series(r, [&](double t_s) { return -r.ambient.at(t_s); }));
  EXPECT_NEAR(likeness(ambient, "ambient", 0), -1.0, 1e-9);
  EXPECT_LT(std::abs(likeness(ambient, "ambient rate", 0)), 0.5);
}

TEST(ResidualStructure, FindsTheTimeConstantOfAStepResponse) {
  const MeasuredRun r = run();
  for (double lag_s : {300.0, 1500.0, 6000.0}) {
    double y = 0.0, before_s = 0.0;
    const auto s = residual_structure(r, series(r, [&](double t_s) {
                                        const double q = r.cyclogram.drive(before_s).speed_rpm;
                                        y = q + (y - q) * std::exp(-(t_s - before_s) / lag_s);
                                        before_s = t_s;
                                        return 0.2 - 1e-3 * y;
                                      }));
    ASSERT_TRUE(s.lag);
    EXPECT_EQ(s.lag->quantity, "speed");
    EXPECT_NEAR(s.lag->time_s / lag_s, 1.0, 0.07);  // 20 trials a decade: 12 % apart
    EXPECT_GT(s.lag->share, 0.99);
  }
}

TEST(ResidualStructure, WhatDoesNotChangeIsLikeNothing) {
  MeasuredRun r = run();
  for (double& v : r.ambient.value) v = 1.7;
  const auto s = residual_structure(r, series(r, [&](double t_s) { return r.cyclogram.drive(t_s).speed_rpm; }));
  EXPECT_TRUE(std::isnan(likeness(s, "ambient", 0)));
}

}  // namespace
}  // namespace driftwright::diagnosis::residual_structure_test
