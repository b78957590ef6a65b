// A touch probe that reports late, and how its lag is undone.

#include "compensation/frames/touch_probe.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "compensation/frames/probe_study.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::compensation::touch_probe_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kPerMin = 1e-3 / 60.0;  // mm/min in m/s

/// Exact but for the lag: no jitter, no pre-travel, an encoder of a nanometre.
ProbeSystem clean() {
  return {
      .lag_s = {8.3e-3, 9.4e-3, 7.7e-3}, .jitter_s = 0.0, .pretravel_m = 0.0, .encoder_step_m = 1e-9, .encoder_bits = 62};
}

// What is left is v times the step of the latch, 1 us: 33 nm at 2000 mm/min; 2 nm of rounding by the encoder.
TEST(LatchedPosition, ResolvesAMicrosecond) {
  Random random(1);
  const double feed_m_s = 2000 * kPerMin;
  for (int i = 0; i < 200; ++i) {
    const Touch t = touch(clean(), {.feed_m_s = feed_m_s, .surface_m = 0.5}, random);
    EXPECT_NEAR(latched_m(t), 0.5 + 8.3e-3 * feed_m_s, 1e-6 * feed_m_s + 2e-9);
  }
}

// The cycle alone: anywhere between the arrival and one cycle later.
TEST(PlainPosition, IsLateByLagAndUpToACycle) {
  Random random(2);
  const double feed_m_s = 1000 * kPerMin;
  double least = 1.0, most = 0.0;
  for (int i = 0; i < 300; ++i) {
    const double late_s = (plain_m(touch(clean(), {.feed_m_s = feed_m_s, .surface_m = 0.5}, random)) - 0.5) / feed_m_s;
    least = std::min(least, late_s);
    most = std::max(most, late_s);
  }
  EXPECT_NEAR(least, 8.3e-3, 5e-5);  // 300 draws of a uniform millisecond leave 5e-5 empty with 1 - 3e-7
  EXPECT_NEAR(most, 9.3e-3, 5e-5);
}

// Real increments do not care whether the axis braked; N v T does, by half of a t^2 or more.
TEST(UndoneLag, HoldsWhileBraking) {
  Random random(3);
  const double feed_m_s = 2000 * kPerMin;
  const Approach braking{.feed_m_s = feed_m_s, .surface_m = 0.5, .deceleration_m_s2 = 0.3, .braking_s = 0.03};
  for (int i = 0; i < 100; ++i) {
    const Touch t = touch(clean(), braking, random);
    // Linear within a cycle: a T^2 / 8 = 38 nm off at most, twice, and v times a microsecond.
    EXPECT_NEAR(latched_and_undone_m(t, 8.3), 0.5, 0.12e-6);
    EXPECT_GT(std::abs(plain_m(t) - 8.8e-3 * feed_m_s - 0.5), 20e-6);
  }
}

TEST(UndoneLag, HoldsWhereTheAxisHasStopped) {
  Random random(4);
  const Approach stopping{.feed_m_s = 300 * kPerMin, .surface_m = 0.5, .deceleration_m_s2 = 1.0, .braking_s = 2e-3};
  const Touch t = touch(clean(), stopping, random);
  EXPECT_EQ(t.increments_m.back(), 0.0);  // 5 ms to a stop, 8.3 ms to the arrival
  EXPECT_NEAR(latched_and_undone_m(t, 8.3), 0.5, 0.3e-6);
}

class RollOver : public ::testing::TestWithParam<int> {};
TEST_P(RollOver, OfTheCounterChangesNothing) {
  ProbeSystem system = clean();
  system.encoder_step_m = 1e-6;
  system.encoder_bits = GetParam();
  Approach approach{.feed_m_s = 2000 * kPerMin, .surface_m = 0.5};
  approach.counter_zero = (std::int64_t{1} << (GetParam() - 1)) - 500'000 - 60;  // 60 um beyond the surface, within the lag
  for (double direction : {1.0, -1.0}) {
    approach.direction = direction;
    Random random(5), again(5);
    Approach quiet = approach;
    quiet.counter_zero = 0;
    ProbeSystem wide = system;
    wide.encoder_bits = 62;
    const Touch t = touch(system, approach, random), plain = touch(wide, quiet, again);
    EXPECT_EQ(t.increments_m, plain.increments_m);
    EXPECT_DOUBLE_EQ(t.position_m, plain.position_m);
  }
}
INSTANTIATE_TEST_SUITE_P(Bits, RollOver, ::testing::Values(16, 32));

// Lags are found from touches alone; 20 us of jitter over 40 touches and feeds up to 2000 mm/min: 20 us / 1 ms / sqrt(40)
// / 0.6.
TEST(Calibration, FindsTheLagOfEachAxis) {
  ProbeStudySettings settings{.system = {}, .feeds_m_s = {}};
  for (double f : {300, 600, 1000, 1500, 2000}) settings.feeds_m_s.push_back(f * kPerMin);
  settings.touches = 1;
  const ProbeStudy study = study_probe(settings);
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_NEAR(study.calibration[a].lag_cycles, 1e3 * settings.system.lag_s[a], 0.02);
    EXPECT_EQ(study.calibration[a].whole_cycles, std::lround(1e3 * settings.system.lag_s[a] + 0.5));
  }
}

// The paper's table: up to 0.33 mm at 10 cycles without correction, 0.0106 mm left; whole cycles leave less than one.
TEST(ProbeStudy, LeavesWhatThePaperLeaves) {
  ProbeStudySettings settings{.system = {}, .feeds_m_s = {}};
  for (double f : {300, 600, 1000, 1500, 2000}) settings.feeds_m_s.push_back(f * kPerMin);
  settings.system.lag_s = {7.5e-3, 9.97e-3, 8.6e-3};
  const ProbeStudy study = study_probe(settings);
  ASSERT_EQ(study.rows.size(), 3u * 5u * 4u);
  for (const ProbeRow& row : study.rows) {
    SCOPED_TRACE(row.motion + " axis " + std::to_string(row.axis) + " at " + std::to_string(row.feed_m_s / kPerMin));
    EXPECT_LE(row.worst.corrected_m, 10.6e-6);
    // one cycle, and beside it jitter of 4 sigma and two steps of the encoder
    EXPECT_LE(row.worst.whole_m, row.feed_m_s * (1e-3 + 80e-6) + 2e-6);
    if (row.motion != "braking") {
      EXPECT_GT(row.worst.plain_m, 6.5e-3 * row.feed_m_s);
    }
  }
  const auto most = [&](auto member) {
    double worst_m = 0.0;
    for (const ProbeRow& row : study.rows) worst_m = std::max(worst_m, row.worst.*member);
    return worst_m;
  };
  EXPECT_NEAR(most(&ProbeErrors::plain_m), 0.36e-3, 0.03e-3);  // 9.97 to 10.97 cycles of 33 um
  EXPECT_GT(most(&ProbeErrors::by_speed_m), 40e-6) << "N v T is wrong in the ramp";
}

// A lag that is the same both ways cancels in the middle of a ring; one touch a ring keeps it where the feed has changed.
TEST(ProbeStudy, ShiftOfTheFrameSuffersFromOneTouchAndAnotherFeed) {
  ProbeStudySettings settings{.system = {}, .feeds_m_s = {300 * kPerMin, 2000 * kPerMin}};
  for (const ShiftRow& row : study_probe(settings).shifts) {
    if (row.reading == "latch and increments") {
      EXPECT_LT(row.worst_shift_m, 6e-6);
    }
    if (row.reading == "plain" && row.touches == "four") {
      EXPECT_LT(row.rms_shift_m, 15e-6);
    }
    if (row.reading == "plain" && row.touches == "one" && row.feed_before_m_s != row.feed_now_m_s) {
      EXPECT_NEAR(row.rms_shift_m, 8.8e-3 * 1700 * kPerMin, 15e-6);
    }
  }
}

TEST(Ring, CentreOfFourTouchesIsFreeOfAnEqualLag) {
  const ProbeSystem system = {.jitter_s = 0.0, .pretravel_m = 8e-6, .encoder_step_m = 1e-9, .encoder_bits = 62};
  Random random(6);
  const ReadTouch read = [](const Touch& t, int) { return latched_m(t); };
  const RingProbing probing{.feed_m_s = 600 * kPerMin, .free_diameter_m = 0.044, .rounds = 3};
  const RingCentre ring = measure_ring(system, probing, {4.8, -0.3}, read, random);
  EXPECT_NEAR(ring.centre_m[0], 4.8, 2e-8);
  EXPECT_NEAR(ring.centre_m[1], -0.3, 2e-8);
  EXPECT_NEAR(ring.diameter_m, 0.044 + 2 * (8e-6 + 0.5 * (8.3e-3 + 9.4e-3) * 0.01), 5e-8);
  EXPECT_NEAR(ring.out_of_round_m, 2 * (8.3e-3 - 9.4e-3) * 0.01, 5e-8);
  EXPECT_LT(ring.scatter_m, 2e-8);
}

TEST(Ring, RefusesTouchesThatCannotBe) {
  const RingTouches good{0.025, -0.025, 0.025, -0.025};
  const auto centre = [](RingTouches t) { return [t] { (void)ring_centre(std::span(&t, 1), 0.05); }; };
  EXPECT_NO_THROW(centre(good)());
  RingTouches wrong = good;
  std::swap(wrong.plus_x_m, wrong.minus_x_m);  // from outside
  EXPECT_THAT(centre(wrong), ThrowsMessage<InputError>(HasSubstr("wrong side")));
  wrong = good;
  wrong.minus_y_m = 0.02;
  EXPECT_THAT(centre(wrong), ThrowsMessage<InputError>(HasSubstr("along Y")));
  wrong.minus_y_m = std::nullopt;
  EXPECT_THAT(centre(wrong), ThrowsMessage<InputError>(HasSubstr("missing")));
  EXPECT_THROW((void)ring_centre({}, 0.05), InputError);
}

TEST(Calibration, WantsASlowReference) {
  Random random(7);
  const auto at = [&](double feed) {
    return FeedTouch{1.0, feed * kPerMin, touch({}, {.feed_m_s = feed * kPerMin, .surface_m = 0.1}, random)};
  };
  const std::vector<FeedTouch> slow = {at(10)}, too_fast = {at(31)}, fast = {at(300), at(2000)};
  EXPECT_NO_THROW((void)calibrate_probe(1e-3, slow, fast));
  EXPECT_REFUSED(calibrate_probe(1e-3, too_fast, fast), "30 mm/min");
  EXPECT_THROW((void)calibrate_probe(1e-3, {}, fast), InputError);
  EXPECT_THROW((void)calibrate_probe(1e-3, slow, std::span(fast).first(1)), InputError);
}

TEST(Touch, RefusesWhatCannotTrigger) {
  Random random(8);
  const Approach stops{.feed_m_s = 0.01, .surface_m = 0.0, .deceleration_m_s2 = 1.0, .braking_s = 0.011};
  EXPECT_THROW((void)touch({}, stops, random), RangeError);
  Approach barely = stops;
  barely.braking_s = 0.0099;  // 5 nm of way left
  EXPECT_THROW((void)touch({}, barely, random), RangeError);
  const Touch t = touch({}, {.feed_m_s = 0.01}, random);
  EXPECT_THROW((void)undone_m(t, 51), RangeError);
  EXPECT_THROW((void)latched_and_undone_m(t, 49.5), RangeError);
}

}  // namespace
}  // namespace driftwright::compensation::touch_probe_test
