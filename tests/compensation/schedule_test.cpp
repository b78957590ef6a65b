// Plans of a cyclogram, and the paper's notation of them.

#include "compensation/schedule/schedule.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "compensation/schedule/schedule_policy.hpp"
#include "compensation/sensors/interpolate.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::compensation::schedule_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::vector<double> seconds(std::vector<double> minutes) {
  for (double& t : minutes) t *= 60.0;
  return minutes;
}

Schedule plan_min(const std::vector<double>& time_min, const std::vector<double>& drift_um,
                  const std::vector<double>& boundaries_min, const ScheduleOptions& options = {}) {
  return plan_cyclogram(seconds(time_min), drift_um, seconds(boundaries_min), options);
}

constexpr ScheduleOptions kPaper{.policy = SchedulePolicy::kPaper};

// 0.5 um/min passes 10, 20, 30 um at 20, 40, 60 min: the paper corrects at each, though there are two samples only. The
// fewest: 20 um serve from 10 to 30 um, and from there the middle of 35 - 10 and 30 + 10.
TEST(Schedule, OfALinearRampIsPlannedByEitherPolicy) {
  const Schedule paper = plan_min({0, 70}, {0, 35}, {0, 70}, kPaper);
  EXPECT_EQ(to_text(paper), "4-{20,20,20,10}-{0,10,10,10}\n");
  EXPECT_NEAR(paper.worst_remaining_um, 10.0, 1e-9);
  EXPECT_TRUE(paper.inside_band);
  const Schedule fewest = plan_min({0, 70}, {0, 35}, {0, 70});
  EXPECT_EQ(to_text(fewest), "3-{20,40,10}-{0,20,12.5}\n");
  EXPECT_NEAR(fewest.worst_remaining_um, 10.0, 1e-9);
  EXPECT_TRUE(fewest.inside_band);
}

// Polyakov et al.: tolerance 10 um, five operations of 60 min. The drift curve is made to pass 10, 20, 30, 40
// um at 18, 45, 75, 115 min and 50 um never; the text is the paper's.
TEST(Schedule, ReproducesThePapersExample) {
  const Schedule s = plan_min({0, 18, 45, 75, 115, 300}, {0, 10, 20, 30, 40, 49}, {0, 60, 120, 180, 240, 300}, kPaper);
  EXPECT_EQ(to_text(s), "3-{18,27,15}-{0,10,10}\n3-{15,40,5}-{0,10,10}\n1-{60}-{0}\n1-{60}-{0}\n1-{60}-{0}\n");
  EXPECT_DOUBLE_EQ(correction_at(s, 150 * 60.0), 40.0);
}

TEST(Schedule, OfAFallingDriftHasNegativeIncrements) {
  EXPECT_EQ(to_text(plan_min({0, 50}, {0, -25}, {0, 50}, kPaper)), "3-{20,20,10}-{0,-10,-10}\n");
  EXPECT_EQ(to_text(plan_min({0, 50}, {0, -25}, {0, 50})), "2-{20,30}-{0,-17.5}\n");
}

// Up to 20 um in 40 min and back in 40: corrected at 20 min, by 10 um, which leave 10 at the top and -10 at the end.
TEST(Schedule, HoldsTheCorrectionAsLongAsItServes) {
  EXPECT_EQ(to_text(plan_min({0, 40, 80}, {0, 20, 0}, {0, 80})), "2-{20,60}-{0,10}\n");
}

// 10 - 2 = 8 um: nothing until 8 um at 16 min, 16 um until 24 um at 48 min, then the middle of 30 - 8 and 24 + 8.
TEST(Schedule, KeepsTheMarginInReserve) {
  const Schedule s = plan_min({0, 60}, {0, 30}, {0, 60}, {.margin_um = 2.0});
  EXPECT_EQ(to_text(s), "3-{16,32,12}-{0,16,11}\n");
  EXPECT_NEAR(s.worst_remaining_um, 8.0, 1e-9);
  EXPECT_DOUBLE_EQ(s.tolerance_um, 8.0);
}

// 0.1 um/s less a little: 10 um are passed at 100.4 s. Written in whole seconds, the correction comes at 100
// s, when the drift is 9.96 um; at 101 s it would have been 10.06, out of tolerance. With 0.1 s it comes at
// 100.4 s.
TEST(Schedule, RoundsTowardsTheSideThatStaysInsideTheBand) {
  const std::vector<double> t_s = {0, 150.6};
  const std::vector<double> d_um = {0, 15};
  const Schedule whole = plan_cyclogram(t_s, d_um, std::vector<double>{0, 150});
  EXPECT_DOUBLE_EQ(whole.operations[0].corrections[0].interval_s, 100.0);
  EXPECT_TRUE(whole.inside_band);
  const Schedule tenths = plan_cyclogram(t_s, d_um, std::vector<double>{0, 150}, {.resolution_s = 0.1});
  EXPECT_NEAR(tenths.operations[0].corrections[0].interval_s, 100.4, 1e-9);
}

// The drift jumps from 8 to 20 um within the second after 100 s. c must lie in [20 - 10, 8 + 10] during it, and may be
// that until the end. The same downwards.
TEST(Schedule, CorrectsAJumpInTheSecondInWhichItHappens) {
  const std::vector<double> t_s = {0, 100, 101, 200};
  for (double sign : {1.0, -1.0}) {
    const std::vector<double> d_um = {sign * 8, sign * 8, sign * 20, sign * 20};
    const Schedule s = plan_cyclogram(t_s, d_um, std::vector<double>{0, 200});
    ASSERT_EQ(s.operations[0].corrections.size(), 2u);
    EXPECT_DOUBLE_EQ(s.operations[0].corrections[0].interval_s, 100.0);
    EXPECT_NEAR(s.operations[0].corrections[1].delta_um, sign * 14.0, 1e-9);
    EXPECT_TRUE(s.inside_band);
  }
}

// A peak of 15 um at 30 s, between two minutes: written in whole minutes, c must lie in [15 - 10, 0 + 10]
// from the start.
TEST(Schedule, SeesAPeakBetweenTwoWrittenTimes) {
  for (double sign : {1.0, -1.0}) {
    const Schedule s = plan_cyclogram(std::vector<double>{0, 30, 60, 120}, std::vector<double>{0, sign * 15, 0, 0},
                                      std::vector<double>{0, 120}, {.resolution_s = 60.0});
    EXPECT_NEAR(correction_at(s, 0.0), sign * 7.5, 1e-9);
    EXPECT_NEAR(s.worst_remaining_um, 7.5, 1e-9);  // without the correction it would be 15 at 30 s
  }
}

// 25 um within a second cannot be followed inside +-10 um: c would have to lie in [15, 10]. The middle, 12.5, misses by
// the least; a second later 25 serves.
TEST(Schedule, SaysSoWhereTheDriftIsTooFast) {
  const std::vector<double> t_s = {0, 100, 101, 200};
  const Schedule s = plan_cyclogram(t_s, std::vector<double>{0, 0, 25, 25}, std::vector<double>{0, 200});
  EXPECT_FALSE(s.inside_band);
  EXPECT_NEAR(s.worst_remaining_um, 12.5, 1e-9);
  EXPECT_NEAR(correction_at(s, 150.0), 25.0, 1e-9);
}

// A drift of 25 um that is there at the start: two steps in the first interval, or all of it.
TEST(Schedule, CorrectsAtTheStartWhereTheDriftIsThereAlready) {
  EXPECT_EQ(to_text(plan_min({0, 10}, {25, 25}, {0, 10}, kPaper)), "1-{10}-{20}\n");
  EXPECT_EQ(to_text(plan_min({0, 10}, {25, 25}, {0, 10})), "1-{10}-{25}\n");
}

// Property: whatever the drift, |d - c| stays within tolerance - margin at every time, between samples, too. d is
// a wild curve of at most 0.3 um/s, so that a cell of 1 s always has a correction that serves; operations end between
// whole seconds.
TEST(Schedule, KeepsAWildDriftInsideTheTolerance) {
  std::vector<double> t_s, d_um;
  for (int i = 0; i <= 700; ++i) {
    const double t = 7.3 * i;
    t_s.push_back(t);
    d_um.push_back(40.0 * std::sin(t / 400.0) + 15.0 * std::sin(t / 83.0) - 0.004 * t);
  }
  for (const SchedulePolicy policy : {SchedulePolicy::kPaper, SchedulePolicy::kMinimal}) {
    const Schedule s =
        plan_cyclogram(t_s, d_um, std::vector<double>{100.5, 1800, 3000.25, 5000}, {.policy = policy, .margin_um = 1.0});
    double worst_um = 0.0;
    for (double t = 100.5; t <= 5000.0; t += 0.05) {
      worst_um = std::max(worst_um, std::abs(interpolate(t_s, d_um, t) - correction_at(s, t)));
    }
    EXPECT_LE(worst_um, 9.0 + 1e-6);
    EXPECT_GT(worst_um, 8.0);  // corrections are held, not chased
    EXPECT_LE(worst_um, s.worst_remaining_um + 1e-9);
    EXPECT_TRUE(s.inside_band);
    for (const Operation& o : s.operations) {
      double sum_s = 0.0;
      for (const Correction& c : o.corrections) sum_s += c.interval_s;
      EXPECT_NEAR(sum_s, o.end_s - o.start_s, 1e-9);
    }
  }
}

// 4-{20,20,20,10}-{0,10,10,10}, by eye.
TEST(Schedule, CorrectionAtATimeIsTheSumOfTheIncrementsBeforeIt) {
  const Schedule s = plan_min({0, 70}, {0, 35}, {0, 70}, kPaper);
  EXPECT_EQ(correction_at(s, -1.0), 0.0);
  EXPECT_EQ(correction_at(s, 19.9 * 60.0), 0.0);
  EXPECT_EQ(correction_at(s, 20.0 * 60.0), 10.0);
  EXPECT_EQ(correction_at(s, 59.9 * 60.0), 20.0);
  EXPECT_EQ(correction_at(s, 100.0 * 60.0), 30.0);
}

TEST(Schedule, WritesFractionsOfAMinuteWithFourDecimalsAtMost) {
  const Schedule s{.operations = {{0, 100, {{61, 0}, {30, -2.5}, {9, 10}}}}};
  EXPECT_EQ(to_text(s), "3-{1.0167,0.5,0.15}-{0,-2.5,10}\n");  // 61/60, 30/60, 9/60
}

struct BadSeries {
  std::vector<double> time_s, drift_um, boundaries_s;
  const char* message;
};
class ScheduleErrors : public ::testing::TestWithParam<BadSeries> {};

TEST_P(ScheduleErrors, NameWhatIsWrong) {
  const BadSeries& bad = GetParam();
  EXPECT_REFUSED(plan_cyclogram(bad.time_s, bad.drift_um, bad.boundaries_s), bad.message);
}

INSTANTIATE_TEST_SUITE_P(Each, ScheduleErrors,
                         ::testing::Values(BadSeries{{0}, {0}, {0, 1}, "two samples or more"},
                                           BadSeries{{0, 1}, {0}, {0, 1}, "2 times and 1 values"},
                                           BadSeries{{0, 2, 1}, {0, 1, 2}, {0, 1}, "times that increase"},
                                           BadSeries{{0, 1, 2}, {0, NAN, 2}, {0, 1}, "no value at 1 s"},
                                           BadSeries{{0, 10}, {0, 1}, {0}, "boundaries that increase"},
                                           BadSeries{{0, 10}, {0, 1}, {0, 5, 5}, "boundaries that increase"},
                                           BadSeries{{0, 10}, {0, 1}, {0, 11}, "from 0 s to 11 s"},
                                           BadSeries{{0, 10}, {0, 1}, {-1, 5}, "from -1 s to 5 s"}));

TEST(Schedule, RefusesOptionsOutOfRange) {
  const auto plan = [](const ScheduleOptions& options) { (void)plan_min({0, 10}, {0, 1}, {0, 10}, options); };
  EXPECT_THAT([&] { plan({.tolerance_um = 0.0}); }, ThrowsMessage<RangeError>(HasSubstr("tolerance")));
  EXPECT_THAT([&] { plan({.tolerance_um = NAN}); }, ThrowsMessage<RangeError>(HasSubstr("tolerance")));
  EXPECT_THAT([&] { plan({.margin_um = 10.0}); }, ThrowsMessage<RangeError>(HasSubstr("margin")));
  EXPECT_THAT([&] { plan({.margin_um = -1.0}); }, ThrowsMessage<RangeError>(HasSubstr("margin")));
  EXPECT_THAT([&] { plan({.margin_um = NAN}); }, ThrowsMessage<RangeError>(HasSubstr("margin")));
  EXPECT_THAT([&] { plan({.resolution_um = 0.0}); }, ThrowsMessage<RangeError>(HasSubstr("resolution 0 um")));
  EXPECT_THAT([&] { plan({.resolution_s = 0.0}); }, ThrowsMessage<RangeError>(HasSubstr("resolution 0 s")));
}

}  // namespace
}  // namespace driftwright::compensation::schedule_test
