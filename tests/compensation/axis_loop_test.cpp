#include "compensation/injector/axis_loop.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::compensation::axis_loop_test {
namespace {

/// 1 um a cycle, 0.25 um a count at x4.
constexpr Encoder kEncoder{.period_um = 1.0};

AxisLoop plain_loop(Feedback feedback = Feedback::kMotor) {
  AxisLoop loop;
  loop.feedback = feedback;
  loop.encoder = kEncoder;
  return loop;
}

// A tool +3 um too far: 3 / 0.25 = 12 counts forward, and the axis moves by -3 um. It comes to rest beyond the edge that
// it waits for, less than a count of 0.25 um away.
TEST(InjectedAxis, AToolTooFarGetsCountsForwardAndTheAxisMovesBack) {
  for (double sign : {+1.0, -1.0}) {
    InjectedAxis axis(kEncoder, {}, {});
    axis.set_correction(static_cast<std::int64_t>(12 * sign));
    axis.run_until(5.0);
    EXPECT_EQ(axis.injector().inserted(), 12 * sign);
    EXPECT_NEAR(axis.position_um(), -3.0 * sign, 0.25);
    EXPECT_EQ(axis.count(), 0);  // the control believes that nothing has happened
    EXPECT_EQ(axis.control_quarters() - axis.injector().encoder().count(), 12 * sign);
    EXPECT_EQ(axis.control_jumps(), 0);
  }
}

// A warm screw pushes the axis 5 um too far at +500 mm, semi-closed; the linear scale's own growth does it full closed.
// Perfectly predicted, either leaves less than a count and the half insertion of rounding.
TEST(AxisLoop, TheSignIsRightSemiClosedAndFullClosed) {
  for (Feedback feedback : {Feedback::kMotor, Feedback::kScale}) {
    Record record{
        .source = "warm", .time_s = {0, 100, 200}, .channels = {{"screw", "degC", {20, 21, 21}}, {"nose", "um", {0, 0, 0}}}};
    AxisLoop loop = plain_loop(feedback);
    loop.growing_channel = "screw";
    loop.growing_part = feedback == Feedback::kMotor ? GrowingPart::kScrew : GrowingPart::kScale;
    loop.expansion_1_K = 10e-6;
    loop.at_um = 500e3;
    const AxisLoopResult run = run_axis_loop(loop, record, "nose", [](const Record& readings) {
      std::vector<double> error_um;
      for (double t : readings.at("screw").values) error_um.push_back(5.0 * (t - 20.0));
      return error_um;
    });
    EXPECT_NEAR(run.before_um.back(), 5.0, 1e-9);
    EXPECT_EQ(run.with.inserted_quarters.back(), 20);
    EXPECT_NEAR(run.after_um.back(), 0.0, 0.25 + 1e-9);
    EXPECT_EQ(run.with.control_quarters, run.with.encoder_quarters + 20);
  }
}

// 10 um/m/K at 500 mm: 5 um a kelvin. A motor's encoder does not see the screw's, a scale does not see its own; what they
// see is followed by the axis and is no error.
TEST(AxisLoop, OnlyGrowthThatTheFeedbackDoesNotSeeIsAnError) {
  Record record{
      .source = "warm", .time_s = {0, 100, 200}, .channels = {{"part", "degC", {20, 21, 21}}, {"nose", "um", {0, 0, 0}}}};
  const auto error_um = [&](Feedback feedback, GrowingPart part) {
    AxisLoop loop = plain_loop(feedback);
    loop.growing_channel = "part";
    loop.growing_part = part;
    loop.expansion_1_K = 10e-6;
    loop.at_um = 500e3;
    const PredictedFromReadings nothing = [](const Record& readings) {
      return std::vector<double>(readings.n_samples(), 0.0);
    };
    return run_axis_loop(loop, record, "nose", nothing).before_um.back();
  };
  EXPECT_NEAR(error_um(Feedback::kMotor, GrowingPart::kScrew), 5.0, 1e-9);
  EXPECT_EQ(error_um(Feedback::kScale, GrowingPart::kScrew), 0.0);
  EXPECT_EQ(error_um(Feedback::kMotor, GrowingPart::kScale), 0.0);
  EXPECT_NEAR(error_um(Feedback::kScale, GrowingPart::kScale), 5.0, 1e-9);
}

/// Overshoot and settling time of a step of correction at standstill.
struct StepAnswer {
  double overshoot_um = 0.0, settled_s = 0.0, rest_um = 0.0;
};
StepAnswer answer_to_step(double step_um, const InjectorSettings& settings, const Servo& servo) {
  InjectedAxis axis(kEncoder, settings, servo);
  axis.set_correction(std::llround(step_um / kEncoder.quarter_um()));
  StepAnswer answer;
  for (double t_s = 0.0; t_s < 3.0; t_s += 1e-3) {
    axis.run_until(t_s);
    const double miss_um = axis.position_um() + step_um;
    answer.overshoot_um = std::max(answer.overshoot_um, -miss_um);
    if (std::abs(miss_um) > 0.5) answer.settled_s = t_s;
  }
  answer.rest_um = axis.position_um() + step_um;
  EXPECT_TRUE(axis.at_rest());
  return answer;
}

// A slew that nothing holds back makes it a step of position: P position with PI speed may pass it, by 15 % at most at
// these gains, and settles. At 20 um/s the axis follows within two counts (the lag of kv = 40/s is 0.5 um).
TEST(InjectedAxis, AStepOfCorrectionAtStandstillSettles) {
  const StepAnswer at_once = answer_to_step(20.0, {.largest_slew_um_s = 1e6}, {});
  EXPECT_LT(at_once.overshoot_um, 0.15 * 20.0);
  EXPECT_LT(at_once.settled_s, 0.3);
  EXPECT_NEAR(at_once.rest_um, 0.0, 0.25);
  const StepAnswer slewed = answer_to_step(20.0, {.largest_slew_um_s = 20.0}, {});
  EXPECT_LT(slewed.overshoot_um, 0.5);
  EXPECT_GT(slewed.settled_s, 0.9);  // 20 um at 20 um/s
  EXPECT_LT(slewed.settled_s, 1.2);
}

// The paper's reading, one count a cycle: a move backward ends where both lines are low, one forward does not, and there
// the next correction waits until the axis moves.
TEST(InjectedAxis, AtX1ACorrectionWaitsAtStandstillWhereALineIsHigh) {
  InjectedAxis axis(kEncoder, {.counting = Counting::kX1}, {});
  axis.set_correction(-4);
  axis.run_until(2.0);
  EXPECT_GT(axis.position_um(), 0.0);
  EXPECT_NE(axis.injector().encoder().lines() & kLinesAB, 0);
  axis.set_correction(+4);
  axis.run_until(4.0);
  EXPECT_EQ(axis.injector().inserted(), -4);  // waits
  axis.command(100.0, 1000.0);
  axis.run_until(6.0);
  EXPECT_EQ(axis.injector().inserted(), +4);  // a pass came by
}

TEST(InjectedAxis, FollowsACommandWithFeedForward) {
  InjectedAxis axis(kEncoder, {}, {});
  axis.command(2000.0, 10e3);
  axis.run_until(0.1);
  EXPECT_NEAR(axis.position_um() - axis.commanded_um(), 0.0, 15.0);  // of 1000 um, while it accelerates at 2 m/s2
  axis.run_until(1.0);
  EXPECT_NEAR(axis.position_um(), 2000.0, 0.25);
  EXPECT_TRUE(axis.at_rest());
  EXPECT_EQ(axis.count(), 8000);
}

// With A and B exchanged the loop runs away; that is found within 20 counts of way, and the correction stays where it is.
TEST(InjectedAxis, SwappedChannelsAreFoundAndFreezeTheCorrection) {
  InjectedAxis axis(kEncoder, {}, {}, true);
  axis.command(100.0, 1000.0);
  axis.run_until(0.05);
  EXPECT_TRUE(axis.faults().swapped);
  const std::int64_t inserted = axis.injector().inserted();
  axis.set_correction(400);
  axis.run_until(0.1);
  EXPECT_EQ(axis.injector().inserted(), inserted);
  InjectedAxis sound(kEncoder, {}, {});
  sound.command(100.0, 1000.0);
  sound.set_correction(-400);
  sound.run_until(30.0);
  EXPECT_FALSE(sound.faults().swapped);
}

// Braking from full speed the encoder counts against a command that has turned round: a sound axis may do so over its way
// to stop.
TEST(InjectedAxis, AReversalAtSpeedIsNoSwap) {
  for (double period_um : {1.0, 4.0}) {
    for (double feed_um_s : {1e3, 2e3, 5e3, 1e4, 2e4, 5e4, 1e5, 2e5}) {
      InjectedAxis axis({.period_um = period_um}, {}, {});
      axis.command(1e6, feed_um_s);
      axis.run_until(1.0);
      EXPECT_GT(axis.speed_um_s(), 0.9 * feed_um_s);
      axis.command(0.0, feed_um_s);
      axis.run_until(2.0);
      EXPECT_FALSE(axis.faults().swapped) << period_um << " um, " << feed_um_s << " um/s";
    }
  }
  // back slowly from fast
  InjectedAxis axis({.period_um = 4.0}, {}, {});
  axis.command(100e3, 500e3);
  axis.run_until(0.15);
  axis.command(0.0, 1e3);
  axis.run_until(0.6);
  EXPECT_FALSE(axis.faults().swapped);
}

TEST(InjectedAxis, ManyTurnsAndSuddenCorrectionsAreNoSwap) {
  for (double feed_um_s : {1e4, 1e5, 5e5}) {
    InjectedAxis axis({.period_um = 4.0}, {}, {});
    double t_s = 0.0;
    for (int turn = 0; turn < 40; ++turn) {
      axis.command(turn % 2 == 0 ? 20e3 : 0.0, feed_um_s);
      axis.run_until(t_s += 0.013 * (turn % 7 + 1));
    }
    EXPECT_FALSE(axis.faults().swapped) << feed_um_s;
  }
  for (std::int64_t quarters : {200, 1000, 3000}) {
    for (double slew_um_s : {20.0, 1e3, 1e4, 1e6}) {
      InjectedAxis axis({.period_um = 4.0}, {.largest_slew_um_s = slew_um_s}, {});
      axis.set_correction(quarters);
      axis.run_until(200.0);
      EXPECT_FALSE(axis.faults().swapped) << quarters << " at " << slew_um_s;
      EXPECT_EQ(axis.injector().inserted(), quarters);
    }
  }
}

// A swapped encoder at any feed is found before the axis has run away by 20 counts and a few times its way to stop.
TEST(InjectedAxis, ASwapIsFoundAtAnyFeed) {
  for (double feed_um_s : {100.0, 1e3, 1e4, 1e5, 5e5}) {
    InjectedAxis axis(kEncoder, {}, {}, true);
    axis.command(1e6, feed_um_s);
    for (int ms = 1; ms <= 500 && !axis.faults().swapped; ++ms) axis.run_until(1e-3 * ms);
    EXPECT_TRUE(axis.faults().swapped) << feed_um_s;
    EXPECT_LT(std::abs(axis.position_um()), 20.0 * 0.25 + 0.02 * feed_um_s) << feed_um_s;
  }
}

/// Largest miss in the last half second of five after a step of 0.1 um, on an encoder so fine that rounding does not hide
/// the loop; so small that a stable loop stays within its largest acceleration.
double late_miss_um(const Servo& servo) {
  InjectedAxis axis({.period_um = 0.01},
                    {.least_separation_s = 1e-9, .largest_count_rate_1_s = 1e9, .largest_slew_um_s = 1e6}, servo);
  axis.set_correction(40);
  double miss_um = 0.0;
  for (double t_s = 4.5; t_s < 5.0; t_s += servo.period_s) {
    axis.run_until(t_s);
    miss_um = std::max(miss_um, std::abs(axis.position_um() + 0.1));
  }
  return miss_um;
}

// On both sides of the bound, 3 % off. Stable, four counts are left at most; unstable, it grows until the acceleration
// limits it.
TEST(Servo, IsStableAboveTheLeastResetTimeAndNotBelow) {
  for (double gain_1_s : {200.0, 400.0, 1000.0}) {
    Servo servo{.position_gain_1_s = 0.1 * gain_1_s, .speed_gain_1_s = gain_1_s};
    const double bound_s = least_speed_reset_s(servo);
    servo.speed_reset_s = 1.03 * bound_s;
    EXPECT_LT(late_miss_um(servo), 0.01) << gain_1_s;
    servo.speed_reset_s = 0.97 * bound_s;
    EXPECT_GT(late_miss_um(servo), 1.0) << gain_1_s;
  }
  // k = 0.4, p = 0.04: 8 / (0.4 * 2.04) - 2 = 7.804 reset times a period
  EXPECT_NEAR(least_speed_reset_s({}), 1e-3 / 7.80392, 1e-9);
  EXPECT_TRUE(std::isinf(least_speed_reset_s({.speed_gain_1_s = 2000.0})));
}

TEST(CountConverter, CarriesTheRest) {
  CountConverter converter(1.0);
  EXPECT_EQ(converter.insertions(0.4), 0);
  EXPECT_EQ(converter.insertions(0.8), 1);
  EXPECT_EQ(converter.insertions(1.4), 1);
  EXPECT_EQ(converter.insertions(std::nan("")), 1);
  EXPECT_EQ(converter.insertions(-3.4), -3);
  CountConverter calm(1.0, 0.3);
  EXPECT_EQ(calm.insertions(0.7), 0);  // half an insertion and 0.3 um
  EXPECT_EQ(calm.insertions(0.9), 1);
  EXPECT_EQ(calm.insertions(0.4), 1);
}

/// A head that grows by 4 um/K: 12 um in an hour; its thermometer shows all of it.
Record warm_up() {
  Record r{.source = "warm_up", .time_s = {}, .channels = {{"head", "degC", {}}, {"nose", "um", {}}}};
  for (int i = 0; i <= 60; ++i) {
    const double dT_K = 3.0 * (1.0 - std::exp(-i / 15.0));
    r.time_s.push_back(60.0 * i);
    r.channels[0].values.push_back(20.0 + dT_K);
    r.channels[1].values.push_back(4.0 * dT_K);
  }
  return r;
}
std::vector<double> four_um_per_K(const Record& readings) {
  std::vector<double> um;
  for (double t : readings.at("head").values) um.push_back(4.0 * (t - 20.0));
  return um;
}
const ErrorStage& stage_of(const AxisLoopResult& run, const std::string& cause) {
  for (const ErrorStage& s : run.stages) {
    if (s.cause == cause) return s;
  }
  throw std::logic_error("no stage " + cause);
}

TEST(AxisLoop, EachCauseLeavesWhatItMust) {
  AxisLoop loop = plain_loop();
  loop.sampling_s = 10.0;
  const AxisLoopResult perfect = run_axis_loop(loop, warm_up(), "nose", four_um_per_K);
  EXPECT_NEAR(stage_of(perfect, "none").peak_um, 12.0 * (1.0 - std::exp(-4.0)), 1e-9);
  EXPECT_NEAR(stage_of(perfect, "model").peak_um, 0.0, 1e-9);
  EXPECT_NEAR(stage_of(perfect, "thermometers").peak_um, 0.0, 1e-9);
  const double first_minute_um = 12.0 * (1.0 - std::exp(-1.0 / 15.0));
  EXPECT_NEAR(stage_of(perfect, "sampling").peak_um, first_minute_um / 6.0, 1e-9);  // the growth in one period of 10 s
  EXPECT_LE(stage_of(perfect, "resolution").peak_um, first_minute_um / 6.0 + 0.5);  // and half an insertion of 1 um
  EXPECT_GT(stage_of(perfect, "resolution").peak_um, 0.5);
  EXPECT_NEAR(stage_of(perfect, "rate limit").peak_um, stage_of(perfect, "resolution").peak_um, 1e-9);  // 20 um/s is plenty
  EXPECT_LE(std::abs(stage_of(perfect, "axis").peak_um - stage_of(perfect, "rate limit").peak_um), 0.25);  // one count
  EXPECT_EQ(perfect.with.control_quarters, perfect.with.encoder_quarters + perfect.with.inserted_quarters.back());

  loop.thermometers = {.noise_K = 0.1, .resolution_K = 0.0};  // 0.4 um RMS
  const AxisLoopResult noisy = run_axis_loop(loop, warm_up(), "nose", four_um_per_K);
  EXPECT_NEAR(stage_of(noisy, "thermometers").rms_um, 0.4, 0.05);  // of 360 draws: 4 % at one sigma
  loop.injector.largest_slew_um_s = 0.001;                         // 0.01 um a sample against 0.13 um of growth
  const AxisLoopResult slow = run_axis_loop(loop, warm_up(), "nose", four_um_per_K);
  EXPECT_GT(stage_of(slow, "rate limit").peak_um, 6.0);
  EXPECT_NEAR(stage_of(slow, "axis").peak_um, stage_of(slow, "rate limit").peak_um,
              1.75);  // the first insertion comes at once, each is rounded by half of one, and a count
}

TEST(AxisLoop, SamplesDuringAPassDoNotCount) {
  AxisLoop loop = plain_loop();
  loop.motion = {.stroke_um = 1000.0, .feed_um_s = 10e3, .every_s = 60.0};
  const AxisLoopResult run = run_axis_loop(loop, warm_up(), "nose", four_um_per_K);
  EXPECT_EQ(std::count(run.at_rest.begin(), run.at_rest.end(), false), 60);  // at 30, 90, ... s; 0.1 s way, 0.3 s to settle
  EXPECT_LT(run.stages.back().peak_um, 1.0);
  EXPECT_EQ(run.with.control_jumps, 0);
  EXPECT_EQ(run.with.control_quarters, run.with.encoder_quarters + run.with.inserted_quarters.back());
}

// Passes so close that the axis is never at rest at a sample: no error is known, and it must not be reported as 0.
TEST(AxisLoop, RefusesARunWithoutASampleAtRest) {
  AxisLoop loop = plain_loop();
  loop.sampling_s = 10.0;
  loop.motion = {.stroke_um = 1000.0, .feed_um_s = 10e3, .every_s = 0.4};
  EXPECT_REFUSED(run_axis_loop(loop, warm_up(), "nose", four_um_per_K), "at rest at no sample");
}

TEST(AxisLoop, TheLedgerIsChecked) {
  InjectedSeries series;
  series.encoder_quarters = 10;
  series.total_quarters = 8;
  series.waiting_quarters = 3;
  series.control_quarters = 15;
  EXPECT_NO_THROW(require_ledger(series));
  series.control_quarters = 16;
  EXPECT_THROW(require_ledger(series), std::logic_error);
}

TEST(AxisLoop, TheSameSeedGivesTheSameRun) {
  AxisLoop loop = plain_loop();
  loop.sampling_s = 10.0;
  loop.thermometers.noise_K = 0.1;
  EXPECT_EQ(run_axis_loop(loop, warm_up(), "nose", four_um_per_K).after_um,
            run_axis_loop(loop, warm_up(), "nose", four_um_per_K).after_um);
}

TEST(AxisLoop, RefusesBadInput) {
  const AxisLoop loop = plain_loop();
  EXPECT_THROW((void)run_axis_loop(loop, warm_up(), "tail", four_um_per_K), InputError);
  Record gap = warm_up();
  gap.channels[1].values[5] = std::nan("");
  EXPECT_REFUSED(run_axis_loop(loop, gap, "nose", four_um_per_K), "missing");
  AxisLoop bad = loop;
  bad.injector.largest_slew_um_s = 0.0;
  EXPECT_THROW((void)run_axis_loop(bad, warm_up(), "nose", four_um_per_K), RangeError);
  EXPECT_THROW((void)drive_axis(loop, std::vector<double>{0, 1}, std::vector<double>{0}), InputError);
}

}  // namespace
}  // namespace driftwright::compensation::axis_loop_test
