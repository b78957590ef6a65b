#include "compensation/injector/injection_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::compensation::injection_run_test {
namespace {

using ::testing::ElementsAre;

// 10 um at 0.5 um per period are 20 periods. A dither of +-3 periods passes 00 at 1, 2, 3, 2, 1, 0, -1, -2,
// -3, -2, -1, 0: twelve windows a sample, so 12 periods after the first sample and 20 after the second. Then
// -1 um: -2 periods, 22 back.
TEST(SimulatedInjection, FollowsAStepAsFastAsLowWindowsAllow) {
  const std::vector<double> t_s = {0, 60, 180, 240, 300};
  const InjectionResult run = simulate_injection(t_s, std::vector<double>{10, 10, -1, -1, NAN}, 0.5);
  EXPECT_THAT(run.inserted_periods, ElementsAre(12, 20, 8, -2, -2));  // a missing value keeps the target
  EXPECT_THAT(run.inserted_um, ElementsAre(6.0, 10.0, 4.0, -1.0, -1.0));
  EXPECT_EQ(run.max_periods_per_sample, 12);
  EXPECT_DOUBLE_EQ(run.max_rate_um_s, 12 * 0.5 / 120.0);  // over the longest step
  EXPECT_EQ(run.upstream_count, 0);                       // every dither comes home
  EXPECT_EQ(run.downstream_count, 4 * -2);
  EXPECT_EQ(run.n_illegal, 0);
}

TEST(SimulatedInjection, ASmallerDitherIsSlower) {
  const InjectionResult run = simulate_injection(std::vector<double>{0, 1}, std::vector<double>{10, 10}, 1.0, 1);
  EXPECT_THAT(run.inserted_periods, ElementsAre(4, 8));
}

// A drift within the rate limit is followed to the nearest period: the residual never exceeds half of one.
TEST(SimulatedInjection, LeavesHalfAPeriodAtMostOfASlowDrift) {
  std::vector<double> t_s, drift_um;
  for (int i = 0; i < 600; ++i) {
    t_s.push_back(30.0 * i);
    drift_um.push_back(45.0 * (1.0 - std::exp(-t_s.back() / 3000.0)) - 3.0);
  }
  const double period_um = 0.4;
  const InjectionResult run = simulate_injection(t_s, drift_um, period_um);
  double worst_um = 0.0;
  for (std::size_t i = 0; i < t_s.size(); ++i) worst_um = std::max(worst_um, std::abs(drift_um[i] - run.inserted_um[i]));
  EXPECT_LE(worst_um, 0.5 * period_um + 1e-12);
  EXPECT_GT(worst_um, 0.4 * period_um);  // and it is quantised
  EXPECT_EQ(run.downstream_count - run.upstream_count, 4 * run.inserted_periods.back());
}

TEST(SimulatedInjection, RefusesBadInput) {
  const std::vector<double> two = {0, 1};
  EXPECT_THROW((void)simulate_injection(two, two, 0.0), RangeError);
  EXPECT_THROW((void)simulate_injection(two, two, NAN), RangeError);
  EXPECT_THROW((void)simulate_injection(two, two, 1.0, 0), RangeError);
  EXPECT_REFUSED(simulate_injection(two, std::vector<double>{1}, 1.0), "2 times but 1 corrections");
}

}  // namespace
}  // namespace driftwright::compensation::injection_run_test
