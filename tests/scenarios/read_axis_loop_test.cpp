#include "scenarios/reader/read_axis_loop.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::scenarios::read_axis_loop_test {
namespace {

using compensation::Counting, compensation::Feedback;

const AxisLoopContext kContext{.displacements = {"nose_y", "nose_z"},
                               .sensors = {"t1", "t2"},
                               .target = "nose_y",
                               .sensor_resolution_K = 0.1,
                               .encoder_period_um = 1.0,
                               .duration_s = 18000.0};

AxisLoopSettings read(const std::string& block) {
  const ConfigMap in = ConfigMap::read_file(write_file("axis_loop.yaml", "axis_loop:\n" + block));
  return read_axis_loop(in.map("axis_loop").described_by(axis_loop_schema()), kContext);
}

TEST(ReadAxisLoop, DefaultsComeFromTheStudy) {
  const AxisLoopSettings s = read("  feedback: motor\n");
  EXPECT_EQ(s.displacement, "nose_y");
  EXPECT_EQ(s.loop.encoder.period_um, 1.0);
  EXPECT_EQ(s.loop.thermometers.resolution_K, 0.1);
  EXPECT_EQ(s.loop.injector.rules.quarters, 4);
  EXPECT_FALSE(s.loop.injector.rules.anywhere);
  EXPECT_EQ(s.loop.motion.stroke_um, 0.0);
}

TEST(ReadAxisLoop, TakesEveryKeyInItsUnit) {
  const AxisLoopSettings s = read(
      "  displacement: nose_z\n  feedback: scale\n  pitch: 5 mm\n  lines: 2500\n  jitter: 0.1\n  counts: x2\n  insert: "
      "half\n"
      "  window: any\n  least_separation: 100 ns\n  largest_count_rate: 1 MHz\n  largest_slew: 1 mm/s\n  sampling: 500 ms\n"
      "  temperature_noise: 20 mK\n  temperature_resolution: 0 K\n  hysteresis: 200 nm\n  seed: 7\n"
      "  motion: {stroke: 2 mm, feed: 600 mm/min, every: 1 min}\n"
      "  servo: {period: 2 ms, position_gain: 30 1/s, speed_gain: 200 1/s, speed_reset: 10 ms, feed_forward: 0.5, "
      "largest_acceleration: 1 m/s^2}\n"
      "  growth: {of: scale, sensor: t2, expansion: 11.5e-6 1/K, at: 300 mm}\n");
  const compensation::AxisLoop& loop = s.loop;
  EXPECT_EQ(s.displacement, "nose_z");
  EXPECT_EQ(loop.feedback, Feedback::kScale);
  EXPECT_DOUBLE_EQ(loop.encoder.period_um, 2.0);
  EXPECT_DOUBLE_EQ(loop.insertion_um(), 1.0);
  EXPECT_EQ(loop.injector.counting, Counting::kX2);
  EXPECT_TRUE(loop.injector.rules.anywhere);
  EXPECT_DOUBLE_EQ(loop.injector.separation_s(), 1e-6);  // 1 MHz is stricter than 100 ns
  EXPECT_DOUBLE_EQ(loop.injector.largest_slew_um_s, 1000.0);
  EXPECT_DOUBLE_EQ(loop.sampling_s, 0.5);
  EXPECT_DOUBLE_EQ(loop.thermometers.noise_K, 0.02);
  EXPECT_DOUBLE_EQ(loop.hysteresis_um, 0.2);
  EXPECT_DOUBLE_EQ(loop.motion.feed_um_s, 10e3);
  EXPECT_DOUBLE_EQ(loop.servo.largest_acceleration_um_s2, 1e6);
  EXPECT_EQ(loop.growing_channel, "t2");
  EXPECT_EQ(loop.growing_part, compensation::GrowingPart::kScale);
  EXPECT_DOUBLE_EQ(loop.at_um, 300e3);
}

struct Bad {
  const char* block;
  const char* words;
};
class BadAxisLoop : public ::testing::TestWithParam<Bad> {};

TEST_P(BadAxisLoop, IsRefusedWithItsLine) {
  EXPECT_REFUSED(read(GetParam().block), "axis_loop.yaml:2", GetParam().words);
}

INSTANTIATE_TEST_SUITE_P(
    Keys, BadAxisLoop,
    ::testing::Values(Bad{"  feedbck: motor\n", "Did you mean 'feedback'"}, Bad{"  displacement: nose_x\n", "nose_y"},
                      Bad{"  feedback: both\n", "motor"}, Bad{"  signal_period: 0 um\n", "signal_period"},
                      Bad{"  signal_period: 1 um\n  lines: 5\n  pitch: 1 mm\n",
                          "`signal_period` and `pitch` with `lines` exclude each other"},
                      Bad{"  insert: quarter\n  counts: x1\n", "less than one count at x1"},
                      Bad{"  largest_count_rate: 1 um\n", "largest_count_rate"},
                      Bad{"  largest_slew: 0 um/s\n", "largest_slew"}, Bad{"  jitter: 0.5\n", "jitter"},
                      Bad{"  sampling: 1 ms\n", "at most 1e+06"},
                      Bad{"  motion: {stroke: 10 mm, feed: 1 mm/s, every: 15 s}\n", "at least twice"},
                      Bad{"  motion: {stroke: 1 m, feed: 1 m/s, every: 2 s}\n", "shorter stroke"},
                      Bad{"  servo: {speed_gain: 2000 1/s}\n", "at most 1 / period"},
                      Bad{"  servo: {position_gain: 200 1/s}\n", "a quarter of speed_gain"},
                      Bad{"  motion: {stroke: 10 um, feed: 1 mm/s, every: 0.3 s}\n", "every"},
                      Bad{"  motion: {stroke: 10 um, feed: 1 mm/s, every: 310 ms}\n", "more than 0.31 s"},
                      Bad{"  servo: {speed_reset: 0.1 ms}\n", "speed_reset"},
                      Bad{"  servo: {speed_reset: 0.128 ms}\n", "more than 0.000128 s"},
                      Bad{"  growth: {sensor: t1, expansion: 1e-5 1/K, at: 1 m}\n", "of"},
                      Bad{"  growth: {of: nut, sensor: t1, expansion: 1e-5 1/K, at: 1 m}\n", "screw, scale"},
                      Bad{"  growth: {of: screw, sensor: t9, expansion: 1e-5 1/K, at: 1 m}\n", "t1"},
                      Bad{"  growth: {of: screw, sensor: t1, expansion: 1e-5 1/K, at: 1 m, on: 2}\n", "unknown key 'on'"}));

}  // namespace
}  // namespace driftwright::scenarios::read_axis_loop_test
