// Displacements that no temperature makes and errors of instruments, as the user writes them, by value; and what they
// refuse.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "effects/effect.hpp"
#include "effects/learned.hpp"
#include "tests/effects/read_entry.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::effects::reading_effects_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::vector<double> kTime_s = {0, 60, 150, 300, 600, 900};
const Cyclogram kCyclogram{.name = "shift",
                           .sections = {{150, {.speed_rpm = 2000}}, {450, {.speed_rpm = 1000}}, {300, {.speed_rpm = 0}}}};
const TimeSeries kAmbient{{0, 900}, {0.0, 9.0}};

/// Rows a [K], b [K], z [m], tilt [rad].
Eigen::MatrixXd truth() {
  Eigen::MatrixXd outputs(4, 6);
  outputs << 5, 5, 8, 2, 3, 7,  //
      1, 2, 3, 4, 5, 6,         //
      0, 0, 0, 0, 0, 0,         //
      1e-6, 2e-6, 3e-6, 4e-6, 5e-6, 6e-6;
  return outputs;
}
Eigen::MatrixXd told(const ReadingChain& chain, const Cyclogram& cyclogram = kCyclogram) {
  return chain.apply({"a", "b", "z", "tilt"}, {"K", "K", "m", "rad"}, kTime_s, cyclogram, kAmbient, truth());
}
Eigen::MatrixXd told(const std::vector<std::string>& entries, const Cyclogram& cyclogram = kCyclogram) {
  std::vector<Effect> effects;
  for (const std::string& text : entries) effects.push_back(read(text));
  return told(reading_chain(effects, cyclogram.name), cyclogram);
}
constexpr int kA = 0, kB = 1, kZ = 2, kTilt = 3;

void expect_row(const Eigen::MatrixXd& m, int row, const std::vector<double>& expected, double tolerance) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(m(row, static_cast<Eigen::Index>(i)), expected[i], tolerance) << "at " << kTime_s[i] << " s";
  }
}

TEST(SensorBias, FadesFromTheStartOfEachCyclogram) {
  const Eigen::MatrixXd t = told(std::vector<std::string>{"{type: sensor_bias, sensor: a, bias: -2 K, fades: 5 min}"});
  expect_row(t, 0,
             {5 - 2.0, 5 - 2 * std::exp(-0.2), 8 - 2 * std::exp(-0.5), 2 - 2 * std::exp(-1.0), 3 - 2 * std::exp(-2.0),
              7 - 2 * std::exp(-3.0)},
             1e-12);
}

// The drive of 150 s at 2000, 450 s at 1000, then rest, after lags of 1 and 10 min; the ambient grows by 0.01 K/s.
TEST(Learned, FollowsTheSpeedBehindItsTimeConstants) {
  const Eigen::MatrixXd t =
      told(std::vector<std::string>{"{type: learned, displacement: z, follows: speed, at_speed: 2000 rpm, exponent: 2, "
                                    "grows: [[1 min, 4 um], [10 min, -8 um]]}"});
  const auto at = [](double t_s, double tau_s) {
    const double first = -std::expm1(-std::min(t_s, 150.0) / tau_s);
    if (t_s <= 150.0) return first;
    const double second = 0.25 + (first - 0.25) * std::exp(-(std::min(t_s, 600.0) - 150.0) / tau_s);
    return t_s <= 600.0 ? second : second * std::exp(-(t_s - 600.0) / tau_s);
  };
  std::vector<double> expected;
  for (const double t_s : kTime_s) expected.push_back(1e-6 * (4.0 * at(t_s, 60.0) - 8.0 * at(t_s, 600.0)));
  expect_row(t, kZ, expected, 1e-15);
}

TEST(Learned, KeepsAShareOfTheChangeAndAddsToIt) {
  const Eigen::MatrixXd t = told(std::vector<std::string>{
      "{type: learned, sensor: a, follows: running, above: 1500 rpm, rises: [[0 min, 3 K]]}",
      "{type: learned, sensor: a, keeps: 0.5, offset: 1 K, follows: ambient, rises: [[0 min, 0.2 K]]}"});
  // 0 at the start: the ambient's. Half of a, 1 K, 3 K while faster than 1500, 0.2 of the ambient's rise
  expect_row(t, kA, {2.5 + 4, 2.5 + 4 + 0.2 * 0.6, 4 + 1 + 0.2 * 1.5, 1 + 1 + 0.2 * 3, 1.5 + 1 + 0.2 * 6, 3.5 + 1 + 0.2 * 9},
             1e-12);
}

TEST(Learned, LagsBehindTheAmbient) {
  const Eigen::MatrixXd t =
      told(std::vector<std::string>{"{type: learned, displacement: z, follows: ambient, grows: [[5 min, 10 um]]}"});
  const auto at = [](double t_s) { return 0.01 * (t_s - 300.0 * -std::expm1(-t_s / 300.0)); };
  std::vector<double> expected;
  for (const double t_s : kTime_s) expected.push_back(1e-5 * at(t_s));
  expect_row(t, kZ, expected, 1e-12);
}

TEST(Learned, FollowsARecordedColumn) {
  Cyclogram heated = kCyclogram;
  heated.columns = {{"heater", "W", {{0, 150}, {150, 0}}}};
  const Eigen::MatrixXd t = told(
      std::vector<std::string>{
          "{type: learned, sensor: a, follows: column, column: heater_W, at: 100, rises: [[2 min, 1.5 K]]}"},
      heated);
  // 150 W are more than was learned from: as much as at 100
  EXPECT_NEAR(t(kA, 2), 8 + 1.5 * -std::expm1(-150.0 / 120.0), 1e-12);
  EXPECT_NEAR(t(kA, 3), 2 + 1.5 * -std::expm1(-150.0 / 120.0) * std::exp(-150.0 / 120.0), 1e-12);
}

// Row by row, as `follow` has it: what the chain gives of the whole record.
TEST(Learned, AddsToAStreamWhatItAddsToARecord) {
  std::vector<Effect> effects;
  for (const char* text : {"{type: learned, displacement: z, keeps: 0.6, follows: speed, at_speed: 1500 rpm, exponent: 2, "
                           "grows: [[0 min, 3 um], "
                           "[2 min, -4 um]]}",
                           "{type: learned, displacement: z, follows: running, above: 1500 rpm, grows: [[5 min, 7 um]]}",
                           "{type: learned, displacement: z, follows: ambient, grows: [[0 min, 1 um], [10 min, 6 um]]}",
                           "{type: learned, sensor: a, offset: 1 K}"})
    effects.push_back(read(text));
  Eigen::MatrixXd outputs = truth();
  outputs.row(kZ) << 1e-6, 4e-6, 9e-6, 7e-6, 2e-6, 3e-6;
  const Eigen::MatrixXd whole =
      reading_chain(effects, kCyclogram.name)
          .apply({"a", "b", "z", "tilt"}, {"K", "K", "m", "rad"}, kTime_s, kCyclogram, kAmbient, outputs);
  LearnedStream stream(effects, "z");
  EXPECT_TRUE(LearnedStream(effects, "tilt").empty());
  const auto drive = [](double t_s) { return kCyclogram.drive(t_s); };
  stream.begin(outputs(kZ, 0), kAmbient.at(0.0));
  for (std::size_t i = 0; i < kTime_s.size(); ++i) {
    if (i > 0) {
      stream.advance(kTime_s[i] - kTime_s[i - 1], drive(kTime_s[i - 1]), kAmbient.at(kTime_s[i - 1]),
                     kAmbient.at(kTime_s[i]));
      LearnedStream again(effects, "z");
      again.recall(stream.state());
      stream = again;
    }
    const auto row = static_cast<Eigen::Index>(i);
    // after the last row the chain holds the last section's drive
    EXPECT_NEAR(stream.with_learned(outputs(kZ, row), drive(std::min(kTime_s[i], 899.0))), whole(kZ, row), 1e-15) << i;
  }
  EXPECT_THROW(stream.recall({}), InputError);
}

// 2000 rpm for 150 s, then 1000 and rest: beyond a hull of 1000 rpm the square of the speed is 3 more than the amounts hold.
TEST(Learned, MayMissWhatTheLawGoesOnToBeyondItsHull) {
  const auto sd = [](Place kind, const std::string& place, const std::vector<std::string>& entries,
                     const Cyclogram& cyclogram = kCyclogram) {
    std::vector<Effect> effects;
    for (const std::string& text : entries) effects.push_back(read(text));
    return Eigen::MatrixXd(learned_sd_beyond(effects, kind, place, kTime_s, cyclogram));
  };
  const auto lagged = [](double t_s) {
    return -std::expm1(-std::min(t_s, 150.0) / 60.0) * std::exp(-std::max(t_s - 150.0, 0.0) / 60.0);
  };
  const std::vector<std::string> of_speed = {
      "{type: learned, displacement: z, follows: speed, at_speed: 1000 rpm, exponent: 2, error: 0.5, "
      "grows: [[0 min, 4 um], [1 min, 5 um]]}",
      "{type: learned, displacement: z, follows: ambient, grows: [[0 min, 70 um]]}"};
  std::vector<double> expected;
  for (const double t_s : kTime_s) {
    const double at_once = t_s < 150.0 ? 3.0 : 0.0, after_lag = 3.0 * lagged(t_s);
    expected.push_back(1e-6 * std::hypot(4.0 * at_once + 5.0 * after_lag, 0.5 * std::max(at_once, after_lag)));
  }
  expect_row(sd(Place::kDisplacement, "z", of_speed), 0, expected, 1e-15);
  expect_row(sd(Place::kDisplacement, "tilt", of_speed), 0, {0, 0, 0, 0, 0, 0}, 0.0);
  // what follows the turning spindle: in proportion, if the fastest speed is known
  expect_row(sd(Place::kSensor, "a",
                {"{type: learned, sensor: a, follows: running, at_speed: 1600 rpm, error: 0.4, rises: [[0 min, 0.3 K]]}"}),
             0, {0.125, 0.125, 0, 0, 0, 0}, 1e-12);
  expect_row(sd(Place::kSensor, "a", {"{type: learned, sensor: a, follows: running, rises: [[0 min, 0.3 K]]}"}), 0,
             {0, 0, 0, 0, 0, 0}, 0.0);
  Cyclogram heated = kCyclogram;
  heated.columns = {{"heater", "W", {{0, 150}, {300, 0}}}};
  expect_row(
      sd(Place::kSensor, "a",
         {"{type: learned, sensor: a, follows: column, column: heater_W, at: 100, error: 0.5, rises: [[0 min, -1.2 K]]}"},
         heated),
      0, {2.6, 2.6, 0, 0, 0, 0}, 1e-12);
}

TEST(Learned, RefusesWhatDoesNotGoTogether) {
  for (const auto& [entry, says] : {
           std::pair{"{type: learned, sensor: a, follows: ambient, grows: [[1 min, 1 um]]}", "`rises` (K) of a sensor"},
           {"{type: learned, sensor: a}", "the entry learns nothing"},
           {"{type: learned, sensor: a, follows: running}", "must be given together"},
           {"{type: learned, displacement: z, offset: 1 K, keeps: 0.5}", "only for a sensor"},
           {"{type: learned, displacement: z, follows: speed, grows: [[1 min, 1 um]]}", "`at_speed` must be given together"},
           {"{type: learned, displacement: z, follows: column, at: 1, grows: [[1 min, 1 um]]}",
            "the `column` must be given together"},
           {"{type: learned, sensor: a, follows: running, error: 1, rises: [[1 min, 1 K]]}", "`error` requires `at_speed`"},
           {"{type: learned, sensor: a, follows: ambient, error: 1, rises: [[1 min, 1 K]]}",
            "only for what follows a drive"},
           {"{type: learned, sensor: a, follows: ambient, at_speed: 9 rpm, rises: [[1 min, 1 K]]}", "allowed only with"},
       })
    EXPECT_THAT(([entry = std::string(entry)] { (void)read(entry); }), ThrowsMessage<InputError>(HasSubstr(says))) << entry;
}

TEST(SensorPlace, ReadsAShareOfTheAirWhileTheSpindleTurns) {
  const Eigen::MatrixXd t = told(
      std::vector<std::string>{"{type: sensor_place, sensor: a, body: ambient, share: 0.2, acts: while_spindle_turns}"});
  // the ambient grows from 0 to 9 K in 900 s; the spindle is at rest from 600 s on
  expect_row(t, 0, {5 - 1.0, 5 + 0.2 * (0.6 - 5), 8 + 0.2 * (1.5 - 8), 2 + 0.2 * (3 - 2), 3, 7}, 1e-12);
}

TEST(DisplacementPath, ReadsAShareOfAnotherDisplacementAfterWhatThatOneFollows) {
  const Eigen::MatrixXd outputs = truth();
  Eigen::MatrixXd two(5, 6);
  two << outputs, Eigen::RowVectorXd::Constant(6, 4e-6);
  const ReadingChain chain =
      reading_chain({read("{type: displacement_path, displacement: z, of: y, share: 0.25}"),
                     read("{type: displacement_path, displacement: y, body: a, sensitivity: 2 um/K}")},
                    "shift");
  const Eigen::MatrixXd t = chain.apply({"a", "b", "z", "tilt", "y", "mean of a"}, {"K", "K", "m", "rad", "m", "K"}, kTime_s,
                                        kCyclogram, kAmbient, (Eigen::MatrixXd(6, 6) << two, outputs.row(0)).finished());
  for (Eigen::Index i = 0; i < 6; ++i) {
    EXPECT_NEAR(t(4, i), 4e-6 + 2e-6 * outputs(0, i), 1e-15);
    EXPECT_NEAR(t(2, i), 0.25 * t(4, i), 1e-15);
  }
  EXPECT_REFUSED(read("{type: displacement_path, displacement: z, of: y}"), "must be given together");
  EXPECT_REFUSED(read("{type: displacement_path, displacement: z, of: z, share: 0.1}"), "this must be another displacement");
  EXPECT_REFUSED(read("{type: displacement_path, displacement: z, of: y, share: 0.1, gain: 2}"),
                 "no sensitivity, tilt or gain");
  EXPECT_REFUSED(read("{type: displacement_path, displacement: z, of: y, body: a, share: 0.1}"),
                 "exactly one of the three is required");
}

TEST(Readings, AreTheTruthWithoutEffects) {
  EXPECT_EQ(told(ReadingChain{}), truth());
}

TEST(SpindleGrowth, FollowsSpeedBehindOneLagExactly) {
  // 10 um at 1000 rpm, exponent 1, 5 min: towards 20 um for 150 s, 10 um for 450 s, back to nothing.
  const double at150 = 20 * (1 - std::exp(-0.5)), at600 = 10 + (at150 - 10) * std::exp(-1.5);
  const std::vector<double> expected_um = {0,     20 * (1 - std::exp(-0.2)), at150, 10 + (at150 - 10) * std::exp(-0.5),
                                           at600, at600 * std::exp(-1.0)};
  const Eigen::MatrixXd m = told(
      std::vector<std::string>{"{type: spindle_growth, displacement: z, growth: 10 um, at_speed: 1000 rpm, lag: 5 min}"});
  expect_row(1e6 * m, kZ, expected_um, 1e-12);  // rounding
  EXPECT_EQ(m.row(kA), truth().row(kA));
}

TEST(SpindleGrowth, OfATiltIsInMicroradians) {
  const Eigen::MatrixXd m = told(std::vector<std::string>{
      "{type: spindle_growth, displacement: tilt, tilt: 8 urad, at_speed: 2000 rpm, exponent: 3, lag: 1 min}"});
  EXPECT_NEAR(m(kTilt, 1), 2e-6 + 8e-6 * (1 - std::exp(-1.0)), 1e-18);
  EXPECT_NEAR(m(kTilt, 4), 5e-6 + 1e-6 + (8e-6 * (1 - std::exp(-2.5)) - 1e-6) * std::exp(-7.5), 1e-18);  // (1/2)^3 = 1/8
}

TEST(Centrifugal, FollowsTheSquareOfSpeedAtOnce) {
  const Eigen::MatrixXd m =
      told(std::vector<std::string>{"{type: centrifugal, displacement: z, growth: -3 um, at_speed: 1000 rpm}"});
  expect_row(1e6 * m, kZ, {-12, -12, -3, -3, 0, 0}, 1e-12);  // a section holds from its start on
}

TEST(SensorBias, MayComeAndGoWithTheSpindle) {
  const Eigen::MatrixXd m =
      told(std::vector<std::string>{"{type: sensor_bias, sensor: a, bias: 0.5 K, errs: while_spindle_turns}"});
  expect_row(m, kA, {5.5, 5.5, 8.5, 2.5, 3, 7}, 1e-12);  // it is at rest from 600 s on
  EXPECT_EQ(m.row(kB), truth().row(kB));
}

TEST(MountShift, CreepsWithATimeConstant) {
  const Eigen::MatrixXd m =
      told(std::vector<std::string>{"{type: mount_shift, displacement: z, shift: 8 um, time: 1 min, creep: 5 min}"});
  const auto at = [](double t_s) { return 8.0 * (1.0 - std::exp(-(t_s - 60.0) / 300.0)); };
  expect_row(1e6 * m, kZ, {0, 0, at(150), at(300), at(600), at(900)}, 1e-12);
}

TEST(DisplacementPath, FollowsABodyTheAmbientOrAColumn) {
  const auto z_um = [](const std::string& keys) -> Eigen::MatrixXd {
    Cyclogram cyclogram = kCyclogram;
    cyclogram.sections = {{300, {}}, {700, {.feed_m_s = {0.02, 0, 0}}}};  // 1200 mm/min
    cyclogram.columns = {{"bed", "degC", {{0, 300}, {25, 40}}}};
    const Effect e = read("{type: displacement_path, displacement: z, " + keys + "}");
    Eigen::MatrixXd outputs(2, 6);
    outputs << 0, 0, 0, 0, 0, 0,  //
        1, 2, 3, 4, 5, 6;
    return 1e6 *
           reading_chain({e}, "shift").apply({"z", mean_output("head")}, {"m", "K"}, kTime_s, cyclogram, kAmbient, outputs);
  };
  expect_row(z_um("body: head, sensitivity: 3 um/K"), 0, {3, 6, 9, 12, 15, 18}, 1e-12);
  expect_row(z_um("body: ambient, sensitivity: -2 um/K"), 0, {0, -1.2, -3, -6, -12, -18}, 1e-12);
  expect_row(z_um("column: bed, zero: 22 degC, sensitivity: 1 um/K"), 0, {3, 3, 3, 18, 18, 18},
             1e-12);  // held from row to row
  expect_row(z_um("column: bed, gain: 0.5"), 0, {12.5, 12.5, 12.5, 20, 20, 20},
             1e-12);  // the column's value, unchanged
  expect_row(z_um("column: feed_x, gain: 0.002"), 0, {0, 0, 0, 2.4, 2.4, 2.4}, 1e-12);
  // The ambient rises by 0.01 K/s from its start on: after a lag of 100 s it is 0.01 (t - 100 (1 - exp(-t/100)))
  const auto behind = [](double t_s) { return 0.01 * (t_s - 100.0 * (1.0 - std::exp(-t_s / 100.0))); };
  expect_row(z_um("body: ambient, sensitivity: 1 um/K, lag: 1.6666666666666667 min"), 0,
             {0, behind(60), behind(150), behind(300), behind(600), behind(900)}, 1e-9);
}

TEST(DisplacementPath, WantsOneThingToFollow) {
  EXPECT_REFUSED(read("{type: displacement_path, displacement: z, sensitivity: 1 um/K}"), "one of the three");
  EXPECT_REFUSED(read("{type: displacement_path, displacement: z, body: a, column: b, sensitivity: 1 um/K}"),
                 "one of the three");
  EXPECT_REFUSED(read("{type: displacement_path, displacement: z, body: a, sensitivity: 1 um/K, tilt: 1 urad/K}"),
                 "one of the two");
  EXPECT_REFUSED(read("{type: displacement_path, displacement: z, column: feed_x, sensitivity: 1 um/K}"), "of the drive");
  EXPECT_REFUSED(read("{type: displacement_path, displacement: z, column: a_N, gain: 1, sensitivity: 1 um/K}"),
                 "one of them");
  EXPECT_REFUSED(read("{type: displacement_path, displacement: z, body: a, gain: 1}"), "only beside a `column`");
}

TEST(MountShift, IsAStepFromItsTimeOn) {
  const std::vector<std::string> shift = {"{type: mount_shift, displacement: z, shift: 4 um, time: 5 min, in: shift}"};
  expect_row(1e6 * told(shift), kZ, {0, 0, 0, 4, 4, 4}, 1e-12);
  Cyclogram other = kCyclogram;
  other.name = "other";
  expect_row(1e6 * told(shift, other), kZ, {0, 0, 0, 0, 0, 0}, 0.0);
}

TEST(ScaleExpansion, ScalesGrowthButNoShiftOfTheMount) {
  expect_row(1e6 * told(std::vector<std::string>{"{type: mount_shift, displacement: z, shift: 4 um, time: 0 min}",
                                                 "{type: scale_expansion, displacement: z, factor: 0.5}",
                                                 "{type: centrifugal, displacement: z, growth: 2 um}"}),
             kZ, {8, 8, 5, 5, 4, 4}, 1e-12);
}

TEST(ScaleExpansion, LagsBehindALinearSignal) {
  // 1 urad a sample: 1 to 2 urad in 60 s after a lag of 60 s: y = x - slope lag (1 - exp(-t / lag)).
  const Eigen::MatrixXd m = told(std::vector<std::string>{"{type: scale_expansion, displacement: tilt, lag: 1 min}"});
  EXPECT_NEAR(1e6 * m(kTilt, 0), 1.0, 1e-12);
  EXPECT_NEAR(1e6 * m(kTilt, 1), 2.0 - (1.0 - std::exp(-1.0)), 1e-12);
}

TEST(SensorBias, IsAdded) {
  expect_row(told(std::vector<std::string>{"{type: sensor_bias, sensor: a, bias: -0.5 K}"}), kA,
             {4.5, 4.5, 7.5, 1.5, 2.5, 6.5}, 1e-14);
}

TEST(SensorDrift, GrowsFromTheStart) {
  expect_row(told(std::vector<std::string>{"{type: sensor_drift, sensor: b, drift: 12 K/h}"}), kB, {1, 2.2, 3.5, 5, 7, 9},
             1e-13);
}

TEST(SensorLag, IsExactForALinearSignalAndSettledAtTheStart) {
  // Lag 150 s. To 60 s constant; then a rise of 3 K in 90 s; then a fall of 6 K in 150 s.
  const double tau = 150, rise = 3.0 / 90, fall = -6.0 / 150;
  const double at150 = 8 - rise * tau * (1 - std::exp(-0.6));
  const double at300 = 2 - fall * tau + (at150 - 8 + fall * tau) * std::exp(-1.0);
  expect_row(told(std::vector<std::string>{"{type: sensor_lag, sensor: a, lag: 2.5 min}"}), kA, {5, 5, at150, at300}, 1e-12);
}

TEST(SensorLag, OfNothingIsNone) {
  EXPECT_EQ(told(std::vector<std::string>{"{type: sensor_lag, sensor: a, lag: 0 min}"}), truth());
}

TEST(SensorDetached, ReadsAShareOfAir) {
  // Ambient 0.01 K/s: 3 K at 300 s, 6 K at 600 s, 9 K at 900 s.
  expect_row(told(std::vector<std::string>{"{type: sensor_detached, sensor: b, share: 0.75, time: 5 min}"}), kB,
             {1, 2, 3, 0.25 * 4 + 0.75 * 3, 0.25 * 5 + 0.75 * 6, 0.25 * 6 + 0.75 * 9}, 1e-14);
}

TEST(SensorSwap, ExchangesChannels) {
  const Eigen::MatrixXd m = told(std::vector<std::string>{"{type: sensor_swap, sensor: a, with: b}"});
  EXPECT_EQ(m.row(kA), truth().row(kB));
  EXPECT_EQ(m.row(kB), truth().row(kA));
}

TEST(ClockOffset, LateReadingsWereTakenBefore) {
  // 90 s late: at 150 s what was at 60 s, at 300 s the middle of 150 s and ... 210 s = 0.4 of the way from 150 s to 300 s.
  const Eigen::MatrixXd m = told(std::vector<std::string>{"{type: clock_offset, offset: 1.5 min}"});
  expect_row(m, kB, {1, 1, 2, 3.4, 4.7, 5.7}, 1e-12);
  expect_row(1e6 * m, kTilt, {1, 1, 2, 3.4, 4.7, 5.7}, 1e-12);
}

TEST(ClockOffset, EarlyReadingsEndWithTheLast) {
  expect_row(told(std::vector<std::string>{"{type: clock_offset, offset: -150 s}"}), kB, {3, 3.4, 4, 4.5, 5.5, 6}, 1e-12);
}

TEST(Readings, ActInTheirOrder) {
  // Detached at 0 from the body (share 1: ambient 0 0.6 1.5 ...), biased by 1 K, then wired to b's channel.
  const Eigen::MatrixXd m =
      told(std::vector<std::string>{"{type: sensor_swap, sensor: a, with: b}", "{type: sensor_bias, sensor: a, bias: 1 K}",
                                    "{type: sensor_detached, sensor: a, share: 1, time: 0 min}"});
  expect_row(m, kB, {1, 1.6, 2.5, 4, 7, 10}, 1e-13);
  EXPECT_EQ(m.row(kA), truth().row(kB));
}

TEST(Readings, KnowNoOtherNames) {
  EXPECT_THROW((void)told(std::vector<std::string>{"{type: sensor_bias, sensor: c, bias: 1 K}"}), std::logic_error);
  EXPECT_THROW((void)told(std::vector<std::string>{"{type: sensor_bias, sensor: z, bias: 1 K}"}), std::logic_error);
  EXPECT_THROW((void)told(std::vector<std::string>{"{type: centrifugal, displacement: a, growth: 1 um}"}), std::logic_error);
}

struct Bad {
  const char* text;
  const char* message;
};
class BadReadingEffect : public ::testing::TestWithParam<Bad> {};

TEST_P(BadReadingEffect, IsAnInputError) {
  EXPECT_REFUSED(read(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Each, BadReadingEffect,
    ::testing::Values(
        Bad{"{type: sensor_bias, bias: 1 K}", "key 'sensor' is missing"},
        Bad{"{type: sensor_bias, sensor: a}", "key 'bias' is missing"},
        Bad{"{type: sensor_bias, sensor: a, bias: 20 degC}", "it must be a temperature difference in K"},
        Bad{"{type: sensor_swap, sensor: a}", "key 'with' is missing"},
        Bad{"{type: sensor_swap, sensor: a, with: a}", "this must be another sensor"},
        Bad{"{type: sensor_detached, sensor: a, share: 1.5, time: 1 min}", "outside what is allowed"},
        Bad{"{type: clock_offset, clock: x, offset: 1 min}", "unknown key 'clock'"},
        Bad{"{type: spindle_growth, displacement: z, growth: 1 um}", "key 'lag' is missing"},
        Bad{"{type: spindle_growth, displacement: z, lag: 1 min}", "exactly one of the two is required: `growth`"},
        Bad{"{type: centrifugal, displacement: z, growth: 1 um, tilt: 1 urad}",
            "exactly one of the two is required: `growth`"},
        Bad{"{type: mount_shift, displacement: z, time: 1 min}", "exactly one of the two is required: `shift`"},
        Bad{"{type: scale_expansion, displacement: z}", "`factor`, `lag` or both"}));

}  // namespace
}  // namespace driftwright::effects::reading_effects_test
