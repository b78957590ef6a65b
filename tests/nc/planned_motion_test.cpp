// Times of real motion against closed forms: ramps, corners, arcs, jerk.

#include "nc/planned_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "nc/program.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::planned_motion_test {
namespace {

constexpr double kPi = std::numbers::pi, kRounding = 1e-12;
const NcLimits kLimits{.velocity_m_s = {1, 1, 1}, .acceleration_m_s2 = {2, 2, 2}, .jerk_m_s3 = 0.0, .cycle_s = 1e-3};

/// Seconds of a program whose axes are limited.
double seconds(const std::string& text, const NcLimits& limits = kLimits) {
  const NcSettings settings{
      .rapid_m_s = 0.5, .tool_change_s = 8.0, .dwell_P_s = 1.0, .machine_zero_m = {}, .ignored = {}, .limits = limits};
  return read_nc_program(write_file("planned.ngc", text), settings).duration_s();
}

TEST(PlannedMotion, RampsUpAndDown) {
  EXPECT_NEAR(seconds("G1 X100 F6000\nM2\n"), 1.0 + 0.1 / 2.0, kRounding);            // L / v + v / a
  EXPECT_NEAR(seconds("G1 X1 F6000\nM2\n"), 2.0 * std::sqrt(1e-3 / 2.0), kRounding);  // the speed is never reached
  EXPECT_NEAR(seconds("G0 X250\nM2\n"), 0.5 + 0.5 / 2.0, kRounding);
}

TEST(PlannedMotion, KeepsEachAxisWithinItsLimits) {
  NcLimits slow_y = kLimits;
  slow_y.acceleration_m_s2[1] = 1.0;
  slow_y.velocity_m_s[1] = 0.05;
  // On the diagonal y has 1 / sqrt(2) of both: 0.0707 m/s and 1.414 m/s2 along the path.
  const double v = 0.05 * std::sqrt(2.0), a = std::sqrt(2.0), length = 0.1 * std::sqrt(2.0);
  EXPECT_NEAR(seconds("G1 X100 Y100 F6000\nM2\n", slow_y), length / v + v / a, kRounding);
}

TEST(PlannedMotion, PassesFromLineToLineOnOneStraightLine) {
  std::string pieces;
  for (int i = 1; i <= 200; ++i) pieces += "G1 X" + std::to_string(i) + " F6000\n";
  EXPECT_NEAR(seconds(pieces + "M2\n"), seconds("G1 X200 F6000\nM2\n"), 1e-9);
}

// At high speed the planner sees 50 pieces of 0.02 mm alone, 1 mm, in which it must be able to stop: v = sqrt(2 a 1 mm) =
// 63 mm/s, and not 1 m/s.
TEST(PlannedMotion, LooksAheadByFiftyPieces) {
  std::string pieces;
  for (int i = 1; i <= 2000; ++i) pieces += "G1 X" + std::to_string(0.02 * i) + " F60000\n";
  const double v = std::sqrt(2.0 * 2.0 * 1e-3);
  EXPECT_NEAR(seconds(pieces + "M2\n"), 0.04 / v + v / 2.0, 0.01 * 0.04 / v);
  EXPECT_LT(seconds("G1 X40 F60000\nM2\n"), 0.5 * 0.04 / v);
}

TEST(PlannedMotion, StopsWhereItMust) {
  const double one = 1.0 + 0.1 / 2.0;
  EXPECT_NEAR(seconds("G61\nG1 X100 F6000\nY100\nM2\n"), 2.0 * one,
              1e-3);  // exact path; a kink of 90 deg is passed at 0.35 mm/s
  EXPECT_NEAR(seconds("G1 X100 F6000\nM3 S100\nX200\nM2\n"), 2.0 * one, kRounding);  // the spindle waits for the axes
  EXPECT_NEAR(seconds("G1 X100 F6000\nG4 P3\nX200\nM2\n"), 2.0 * one + 3.0, kRounding);
}

TEST(PlannedMotion, RoundsACornerWithinItsTolerance) {
  // Half angle 45 deg, P = 0.1 mm: d = P cos / (1 - sin), R = d, v = sqrt(0.866 a R); each line is shorter by d.
  const double d = 1e-4 * std::sqrt(0.5) / (1.0 - std::sqrt(0.5)), v = std::sqrt(std::sqrt(0.75) * 2.0 * d), a = 2.0,
               feed = 0.1, length = 0.1 - d;
  const double up = feed / a + (feed - v) / a + (length - (feed * feed + feed * feed - v * v) / (2.0 * a)) / feed;
  EXPECT_NEAR(seconds("G64 P0.1\nG1 X100 F6000\nY100\nM2\n"), 2.0 * up + d * 0.5 * kPi / v, 1e-9);
  EXPECT_LT(seconds("G64\nG1 X100 F6000\nY100\nM2\n"), seconds("G64 P0.1\nG1 X100 F6000\nY100\nM2\n"));
}

TEST(PlannedMotion, GoesRoundAsFastAsTheAxesCan) {
  const double v = std::sqrt(std::sqrt(0.75) * 2.0 * 0.01),
               length = 2.0 * kPi * 0.01;  // 0.132 m/s of the programmed 1 m/s, a / 2 along the path
  EXPECT_NEAR(seconds("G2 X0 Y0 I10 F60000\nM2\n"), length / v + v / 1.0, kRounding);
}

TEST(PlannedMotion, ChangesAccelerationNoFasterThanTheJerk) {
  NcLimits limits = kLimits;
  limits.jerk_m_s3 = 50.0;
  EXPECT_NEAR(seconds("G1 X100 F6000\nM2\n", limits), 1.0 + 0.1 / 2.0 + 2.0 / 50.0,
              kRounding);   // v > a^2 / jerk: L / v + v / a + a / jerk
  limits.jerk_m_s3 = 10.0;  // a is not reached: L / v + 2 sqrt(v / jerk)
  EXPECT_NEAR(seconds("G1 X100 F6000\nM2\n", limits), 1.0 + 2.0 * std::sqrt(0.1 / 10.0), kRounding);
}

TEST(PlannedMotion, KeepsStepsAndMovesTogether) {
  const NcSettings settings{
      .rapid_m_s = 0.5, .tool_change_s = 8.0, .dwell_P_s = 1.0, .machine_zero_m = {}, .ignored = {}, .limits = kLimits};
  const NcProgram program = read_nc_program(
      write_file("planned.ngc", "G0 X100\nM3 S100\nG1 Y50 F600\nG81 X10 Z-5 R2 F300\nX20\nG80\nG4 P2\nM2\n"), settings);
  double sum_s = 0.0;
  for (const NcStep& step : program.steps) {
    EXPECT_DOUBLE_EQ(step.start_s, sum_s);
    sum_s = step.end_s;
  }
  EXPECT_NEAR(sum_s, program.duration_s(), 1e-9);
}

}  // namespace
}  // namespace driftwright::planned_motion_test
