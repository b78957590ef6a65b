// NC programs against times and travels computed by hand. A quarter of it is tables of programs and mistakes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "nc/arc.hpp"
#include "nc/positions.hpp"
#include "nc/program.hpp"
#include "nc/sections.hpp"
#include "tests/nc/program_sums.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::nc_program_test {
namespace {

using fixtures::revolutions, fixtures::travel_mm;
using ::testing::DoubleNear, ::testing::ElementsAre, ::testing::HasSubstr;

constexpr double kPi = std::numbers::pi;
constexpr double kRounding = 1e-12;  // relative: sums of a few dozen terms of one sign in double precision

const NcSettings kSettings{.rapid_m_s = 0.25,  // 15 m/min
                           .tool_change_s = 8.0,
                           .dwell_P_s = 1.0,
                           .machine_zero_m = std::array<double, 3>{0.0, 0.0, 0.5},
                           .ignored = {}};

NcProgram read(const std::string& text, const NcSettings& settings = kSettings) {
  return read_nc_program(write_file("nc_program_test.ngc", text), settings);
}

struct Timed {
  const char* name;
  const char* text;
  double seconds;
  std::array<double, 3> travel;  ///< mm
  double revolutions;
};

class NcTimes : public ::testing::TestWithParam<Timed> {};

TEST_P(NcTimes, AreThoseComputedByHand) {
  const NcProgram program = read(GetParam().text);
  EXPECT_NEAR(program.duration_s(), GetParam().seconds, kRounding * GetParam().seconds);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(travel_mm(program)[axis], GetParam().travel[axis], 1e-10) << "axis " << axis;  // mm, of some hundred
  }
  EXPECT_NEAR(revolutions(program), GetParam().revolutions, kRounding * GetParam().revolutions);
}

const double kRoot3 = std::sqrt(3.0);

INSTANTIATE_TEST_SUITE_P(
    Each, NcTimes,
    ::testing::Values(
        // 4 x 50 mm at 600 mm/min = 10 mm/s, at 1200 rpm.
        Timed{"square_pocket", "G21 G90\nS1200 M3\nG1 X50 F600\nY50\nX0\nY0\nM5\nM2\n", 20, {100, 100, 0}, 400},
        // Rapid from 0 to (30, 40, 0): 50 mm at 250 mm/s; S before M3 does not turn the spindle.
        Timed{"rapid_from_zero", "S3000\nG0 X30 Y40\nM3\nG4 P1.5\nM30\n", 0.2 + 1.5, {30, 40, 0}, 75},
        // Quarter circle r = 10 mm, G17, from (0, 0) about (10, 0), clockwise to (10, 10): 5 pi mm at 10 mm/s.
        Timed{"quarter_g17", "G2 X10 Y10 I10 F600\nM2\n", kPi / 2, {10, 10, 0}, 0},
        // The same anticlockwise, three quarters: x 0, 20, 10; y 0, -10, 10.
        Timed{"three_quarters_g17", "G3 X10 Y10 I10 F600\nM2\n", 1.5 * kPi, {30, 30, 0}, 0},
        // G18, right-handed plane (z, x), about z = 10: from 180 deg to 90 deg, which is clockwise.
        Timed{"quarter_g18", "G18 G2 X10 Z10 K10 F600\nM2\n", kPi / 2, {10, 0, 10}, 0},
        Timed{"three_quarters_g18", "G18 G3 X10 Z10 K10 F600\nM2\n", 1.5 * kPi, {30, 0, 30}, 0},
        // G19, right-handed plane (y, z), about y = 10: the same.
        Timed{"quarter_g19", "G19 G2 Y10 Z10 J10 F600\nM2\n", kPi / 2, {0, 10, 10}, 0},
        Timed{"three_quarters_g19", "G19 G3 Y10 Z10 J10 F600\nM2\n", 1.5 * kPi, {0, 30, 30}, 0},
        // Whole circle without axis words, radius 5: 10 pi mm; each axis goes 4 r = 20 mm.
        Timed{"full_circle", "F600\nG2 I5\nM2\n", kPi, {20, 20, 0}, 0},
        Timed{"full_circle_end_is_start", "F600\nG3 X0 Y0 I3 J4\nM2\n", kPi, {20, 20, 0}, 0},
        // Helix of two turns of r = 3 mm with a rise of 16 pi mm: length hypot(12 pi, 16 pi) = 20 pi mm.
        Timed{"helix_of_two_turns", "F600\nG2 I3 Z-50.26548245743669 P2\nM2\n", 2 * kPi, {24, 24, 16 * kPi}, 0},
        // A semicircle with P2 is one and a half turns.
        Timed{"one_and_a_half_turns", "F600\nG2 X10 I5 P2\nM2\n", 1.5 * kPi, {30, 30, 0}, 0},
        // R: chord 10 sqrt(3), r = 10: 120 deg about (5 sqrt(3), 5), down to y = -5; with R < 0 it is 240 deg about
        // (5 sqrt(3), -5), down to y = -15 and on both sides out by 10 - 5 sqrt(3) beyond the ends in x.
        Timed{"radius_short", "F600\nG3 X17.32050807568877 R10\nM2\n", 2 * kPi / 3, {10 * kRoot3, 10, 0}, 0},
        Timed{"radius_long",
              "F600\nG3 X17.32050807568877 R-10\nM2\n",
              4 * kPi / 3,
              {10 * kRoot3 + 4 * (10 - 5 * kRoot3), 30, 0},
              0},
        Timed{"radius_short_clockwise", "F600\nG2 X17.32050807568877 R10\nM2\n", 2 * kPi / 3, {10 * kRoot3, 10, 0}, 0},
        Timed{"absolute_centre",
              "G90.1 F600\nG0 X10 Y10\nG2 X20 Y20 I20 J10\nM2\n",
              std::hypot(10.0, 10.0) / 250 + kPi / 2,
              {20, 20, 0},
              0},
        // Inch: 1 in at 10 in/min = 6 s; the F of the block is in inches, too. Then back to mm.
        Timed{"inch", "G20 G1 X1 F10\nG21\nG1 X0 F254\nM2\n", 6 + 6, {50.8, 0, 0}, 0},
        Timed{"incremental",
              "G91 F600\nG1 X10\nX10 Y-5\nG90\nX0 Y0\nM2\n",
              1 + std::hypot(10.0, 5.0) / 10 + std::hypot(20.0, 5.0) / 10,
              {40, 10, 0},
              0},
        // 0.1 mm/rev at 600 rpm = 1 mm/s.
        Timed{"feed_per_revolution", "G95 S600 M3\nG1 X30 F0.1\nM2\n", 30, {30, 0, 0}, 300},
        // G93 F4: each move takes a quarter of a minute, however long.
        Timed{"inverse_time", "G93 G1 X30 F4\nX130 F6\nG94 F600\nX140\nM2\n", 15 + 10 + 1, {140, 0, 0}, 0},
        Timed{"dwell_of_x_and_u", "S60 M4\nG4 X2.5\nG4 U1\nM2\n", 3.5, {0, 0, 0}, 3.5},
        // M6 takes 8 s at rest and stops the spindle until the next M3; M3 in the block of M6 comes after it.
        Timed{"tool_change", "S600 M3\nG4 P1\nT2 M6\nG4 P1\nM6 M3\nG4 P1\nM2\n", 1 + 8 + 1 + 8 + 1, {0, 0, 0}, 20},
        // Small letters, blanks inside words, comments, N words, signs, % and words after the end.
        Timed{"lexical", "%\nO77\n(no ; end here) n1 g 1 x+1 0. f6 00 ; G0 X100\n/N2X-10(back)\n%\nG77\n", 3, {30, 0, 0}, 0},
        // Three holes 20 mm apart: from 10 to R = 2 at rapid, to -8 at 5 mm/s, at rapid back to 10.
        Timed{"g81_g98",
              "G0 Z10\nG81 X20 Z-8 R2 F300\nX40\nX60\nG80\nM2\n",
              10.0 / 250 + 3 * (20.0 / 250 + 8.0 / 250 + 10.0 / 5 + 18.0 / 250),
              {60, 0, 10 + 3 * 36},
              0},
        Timed{"g81_g99_from_below",
              "G99 G81 X20 Z-8 R2 F300\nX40\nG80\nM2\n",
              2.0 / 250 + 2 * (20.0 / 250 + 10.0 / 5 + 10.0 / 250),
              {40, 0, 2 + 2 * 20},
              0},
        // LinuxCNC's example 2, from (1, 2, 3): up to 4.8, three holes of 0.6 mm, 4 and 5 mm apart.
        Timed{"g81_incremental_repeat",
              "G0 X1 Y2 Z3\nF36\nG91 G98 G81 X4 Y5 Z-0.6 R1.8 L3\nM2\n",
              std::sqrt(14.0) / 250 + 1.8 / 250 + 3 * (std::hypot(4.0, 5.0) / 250 + 0.6 / 0.6 + 0.6 / 250),
              {1 + 12, 2 + 15, 3 + 1.8 + 3 * 1.2},
              0},
        Timed{"g82_dwell", "G82 X0 Z-5 R0 P2 F300\nX0\nM2\n", 2 * (1 + 2 + 5.0 / 250), {0, 0, 20}, 0},
        // Pecks of 4 mm to -10 from R = 0: feeds 4, then 4.254, then 2.254; out 4 and 8, back 3.746 and 7.746, out 10.
        Timed{"g83_pecks",
              "G83 X0 Z-10 R0 Q4 F300\nM2\n",
              10.508 / 5 + (4 + 3.746 + 8 + 7.746 + 10) / 250,
              {0, 0, 10.508 + 33.492},
              0},
        // The same with chip breaking: up 0.254 twice.
        Timed{"g73_pecks", "G73 X0 Z-10 R0 Q4 F300\nM2\n", 10.508 / 5 + 10.508 / 250, {0, 0, 21.016}, 0},
        Timed{"g84_tapping", "S300 M3\nG84 X0 Z-10 R0 F300\nM2\n", 4, {0, 0, 20}, 20},
        Timed{"g85_boring", "G0 Z5\nG85 X0 Z-10 R0 F300\nM2\n", 5.0 / 250 + 5.0 / 250 + 4 + 5.0 / 250, {0, 0, 35}, 0},
        // Drilling along x in the plane G19.
        Timed{"g81_in_g19", "G19 G81 Y20 X-8 R0 F300\nM2\n", 20.0 / 250 + 8.0 / 5 + 8.0 / 250, {16, 20, 0}, 0},
        // Machine zero 500 mm above the program's: by way of z = 10, then home; then G53 to z = -100 of the machine.
        Timed{"g28_g53", "G91 G28 Z10\nG90 G53 G0 Z-100\nM2\n", 0.5 / 0.25 + 0.1 / 0.25, {0, 0, 600}, 0}),
    [](const auto& timed) { return std::string(timed.param.name); });

TEST(NcArc, TravelsAreTheIntegralsOfTheAbsoluteVelocities) {
  // Against the sum over a million chords: its error is (sweep / 1e6)^2 / 24 of the length and one chord per reversal.
  const double r = 0.02, from = 0.3, sweep = 5.1;
  const auto at = [&](double a) { return std::array<double, 3>{0.1 + r * std::cos(a), -0.2 + r * std::sin(a), 0.0}; };
  const ArcPath path = arc_path(at(from), at(from + sweep), {0.1, -0.2, 0.0}, 2, false, 1, 5e-6);
  double x_m = 0.0, y_m = 0.0;
  constexpr int kChords = 1000000;
  for (int i = 0; i < kChords; ++i) {
    const auto a = at(from + sweep * i / kChords), b = at(from + sweep * (i + 1) / kChords);
    x_m += std::abs(b[0] - a[0]);
    y_m += std::abs(b[1] - a[1]);
  }
  EXPECT_NEAR(path.length_m, r * sweep, 1e-15);
  EXPECT_NEAR(path.travel_m[0], x_m, 1e-12);
  EXPECT_NEAR(path.travel_m[1], y_m, 1e-12);
}

TEST(NcArc, OfRoundedNumbersIsASpiral) {
  // Radii that differ by up to what two decimals of a millimetre come to, against the sum over chords. The travels take the
  // radius as its mean.
  struct Spiral {
    double radius_m, growth_m, sweep;
    bool clockwise;
  };
  for (const Spiral& c : {Spiral{2e-3, 28e-6, 0.7, false}, Spiral{2e-3, -28e-6, 0.7, true}, Spiral{2e-3, 28e-6, 1e-3, false},
                          Spiral{5e-2, -20e-6, 6.1, true}, Spiral{1e-3, 25e-6, 7.5, false}}) {
    const double sense = c.clockwise ? -1.0 : 1.0;
    const auto at = [&](double share) {
      const double r_m = c.radius_m + share * c.growth_m, angle = 0.3 + sense * share * c.sweep;
      return std::array<double, 3>{0.1 + r_m * std::cos(angle), -0.2 + r_m * std::sin(angle), 1e-3 * share};
    };
    const ArcPath path = arc_path(at(0), at(1), {0.1, -0.2, 0.0}, 2, c.clockwise, c.sweep > 2 * kPi ? 2 : 1, 5e-6);
    constexpr int kChords = 100000;
    double length_m = 0.0, x_m = 0.0, y_m = 0.0;
    for (int i = 0; i < kChords; ++i) {
      const auto a = at(double(i) / kChords), b = at(double(i + 1) / kChords);
      length_m += std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
      x_m += std::abs(b[0] - a[0]);
      y_m += std::abs(b[1] - a[1]);
    }
    EXPECT_NEAR(path.length_m / length_m, 1.0, 1e-5);
    EXPECT_NEAR(path.radius_m, c.radius_m + 0.5 * c.growth_m, 1e-12);
    EXPECT_NEAR(path.travel_m[0], x_m, 0.25 * std::abs(c.growth_m));
    EXPECT_NEAR(path.travel_m[1], y_m, 0.25 * std::abs(c.growth_m));
    EXPECT_NEAR(path.travel_m[2], 1e-3, 1e-15);
    const auto direction = [&](double from, double to) {
      const auto a = at(from), b = at(to);
      const double chord_m = std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
      return std::array<double, 3>{(b[0] - a[0]) / chord_m, (b[1] - a[1]) / chord_m, (b[2] - a[2]) / chord_m};
    };
    for (int axis = 0; axis < 3; ++axis) {  // chords of 1e-6 of the arc: turned by half of that angle, below 1e-5
      EXPECT_NEAR(path.begins[axis], direction(0, 1e-6)[axis], 1e-5) << "axis " << axis;
      EXPECT_NEAR(path.ends[axis], direction(1 - 1e-6, 1)[axis], 1e-5) << "axis " << axis;
    }
  }
}

TEST(NcArc, GoesRoundOnceWhereStartAndEndLieInOneDirection) {
  // (1.2, 1.6) and (1.194, 1.592) from the centre: 2 mm and 1.99 mm at the same angle, but for the noise of atan2.
  for (const bool clockwise : {false, true}) {
    const ArcPath path = arc_path({1.2e-3, 1.6e-3, 0}, {1.194e-3, 1.592e-3, 0}, {0, 0, 0}, 2, clockwise, 1, 5e-6);
    EXPECT_NEAR(path.length_m, std::hypot(2 * kPi * 1.995e-3, 1e-5), 1e-12);
    EXPECT_NEAR(path.travel_m[0], 4 * 1.995e-3, 1e-5);
  }
}

struct Rounded {
  const char* name;
  const char* text;
  bool allowed;
};

class NcRounding : public ::testing::TestWithParam<Rounded> {};

TEST_P(NcRounding, IsAllowedAsFarAsWrittenDecimalsExplainIt) {
  if (GetParam().allowed) {
    EXPECT_GT(read(GetParam().text).duration_s(), 0.0);
  } else {
    EXPECT_THROW((void)read(GetParam().text), InputError);
  }
}

// Centre: 4 sqrt(2) e is 0.02828 mm with e = 0.005 mm, and 0.002828 in with e = 0.0005 in. Radius: (1 + sqrt(2)) e is
// 0.01207 mm and 0.001207 in, on half of the chord. The relative tolerance of 0.1 % ends at 0.5 mm.
INSTANTIATE_TEST_SUITE_P(Each, NcRounding,
                         ::testing::Values(Rounded{"mm_below", "G2 X4.028 I2 F100\nM2\n", true},
                                           Rounded{"mm_above", "G2 X4.029 I2 F100\nM2\n", false},
                                           Rounded{"mm_inwards", "G3 X3.972 I2 F100\nM2\n", true},
                                           Rounded{"mm_inwards_above", "G3 X3.971 I2 F100\nM2\n", false},
                                           Rounded{"inch_below", "G20 G2 X0.2028 I0.1 F10\nM2\n", true},
                                           Rounded{"inch_above", "G20 G2 X0.2029 I0.1 F10\nM2\n", false},
                                           Rounded{"other_plane", "G18 G2 Z4.028 K2 F100\nM2\n", true},
                                           Rounded{"absolute_centre", "G90.1 G2 X4.028 I2 J0 F100\nM2\n", true},
                                           Rounded{"large_below", "G2 X400.19 I200 F100\nM2\n", true},
                                           Rounded{"large_above", "G2 X400.21 I200 F100\nM2\n", false},
                                           Rounded{"very_large_below", "G2 X4000.49 I2000 F100\nM2\n", true},
                                           Rounded{"very_large_above", "G2 X4000.51 I2000 F100\nM2\n", false},
                                           Rounded{"r_mm_below", "G2 X4.024 R2 F100\nM2\n", true},
                                           Rounded{"r_mm_above", "G2 X4.025 R2 F100\nM2\n", false},
                                           Rounded{"r_inch_below", "G20 G2 X0.2024 R0.1 F10\nM2\n", true},
                                           Rounded{"r_inch_above", "G20 G2 X0.2025 R0.1 F10\nM2\n", false}),
                         [](const auto& rounded) { return std::string(rounded.param.name); });

// The half circle from (0, 0) to (20, 0) about (10, 0) clockwise rises to y = 10 mm; the drilling goes to z = -8 mm; after
// G92 the words count from another origin.
TEST(NcProgram, KnowsWhatEachBlockAsksOfTheMachine) {
  const NcProgram program =
      read("G21 G90 S1200 M3\nG2 X20 Y0 I10 J0 F300\nG81 X30 Z-8 R2 F90\nG80\nG92 X0\nG1 X5 F600\nG0 X9\nM2\n");
  const auto demand = [&](std::size_t step) { return program.steps[step].demand; };
  EXPECT_NEAR(demand(1).high_m[1], 0.010, 1e-12);
  EXPECT_NEAR(demand(1).low_m[1], 0.0, 1e-12);
  EXPECT_NEAR(demand(1).high_m[0], 0.020, 1e-12);
  EXPECT_GT(demand(1).low_m[2], demand(1).high_m[2]) << "z is not commanded";
  EXPECT_NEAR(demand(1).feed_m_s, 0.005, 1e-12);
  EXPECT_NEAR(demand(1).speed_rpm, 1200.0, 1e-9);
  EXPECT_NEAR(demand(2).low_m[2], -0.008, 1e-12);
  EXPECT_NEAR(demand(5).high_m[0], 0.035, 1e-12);
  EXPECT_NEAR(demand(5).feed_m_s, 0.010, 1e-12);
  EXPECT_EQ(demand(6).feed_m_s, 0.0) << "a rapid has no programmed feed";
  EXPECT_NEAR(demand(6).high_m[0], 0.039, 1e-12);
}

TEST(NcArc, OfTwoDecimalsEndsWhereItIsWritten) {
  // An eighth of r = 5 mm from (0, 0) about (3.5355, 3.5355), each number rounded to 0.01 mm: radii 5.0063 and 4.9992 mm.
  const NcProgram program = read("G3 X7.07 I3.54 J3.54 F600\nG1 X17.07\nM2\n");
  const double r1 = std::hypot(3.54, 3.54), r2 = std::hypot(3.53, 3.54);
  const double sweep = std::atan2(-3.54, 3.53) - std::atan2(-3.54, -3.54);
  EXPECT_NEAR(program.moves[0].duration_s, std::hypot(0.5 * (r1 + r2) * sweep, r2 - r1) / 10, 1e-12);
  EXPECT_NEAR(program.moves[1].duration_s, 1.0, 1e-12);
}

/// First blocks of programs as posts write them: what is off beforehand may be cancelled beside a motion word.
class NcSafeStart : public ::testing::TestWithParam<const char*> {};

TEST_P(NcSafeStart, IsRead) {
  const NcProgram program = read(std::string(GetParam()) + "\nG21 G0 X25\nG4 P1\nM30\n");
  EXPECT_NEAR(program.duration_s(), 0.1 + 1, 1e-12) << GetParam();
  EXPECT_TRUE(program.notes.empty()) << GetParam();
}

INSTANTIATE_TEST_SUITE_P(Each, NcSafeStart,
                         ::testing::Values("G00 G17 G21 G40 G49 G80 G90", "N10G0G17G40G49G80G90",
                                           "G0 G17 G20 G40 G49 G80 G90 G94 G98", "G90 G94 G17 G49 G40 G80",
                                           "G21 G0 G40 G49 G80 G99", "G80 G40 G49 G0 G90 G54 G21", "G17 G54 G40 G49 G80 G90",
                                           "G90 G80 G40 G17 G49 G69 G15", "G0 G40 G49 G50 G67 G69 G80 G90",
                                           "G15 G17 G40 G49 G50.1 G69 G80 G94 G97 G98",
                                           "G90 G94 G91.1 G40 G49 G17 G64 P0.05", "G1 G40 G80 F100", "G80 M5 M9",
                                           "G91 G80 G90.1 G61"));

TEST(NcProgram, G80BesideAMotionWordEndsTheCycleAndTheOtherIsTheMotion) {
  // Three holes of 2 s in and 0.04 s out, and between them a rapid, a line at 5 mm/s and a half circle, which do not drill.
  const std::string hole = " Z-10 R0 F300\n";
  const NcProgram program =
      read("G81 X0" + hole + "G80 G0 X20\nG81 X20" + hole + "G1 G80 X30\nG81 X30" + hole + "G80 G2 X40 I5\nG4 P1\nM2\n");
  EXPECT_NEAR(program.duration_s(), 3 * (2 + 10.0 / 250) + 20.0 / 250 + 2 + kPi + 1, 1e-9);
  EXPECT_NEAR(travel_mm(program)[2], 60, 1e-9);
}

TEST(NcProgram, DwellsInMillisecondsWhereTheSettingsSaySo) {
  NcSettings fanuc = kSettings;
  fanuc.dwell_P_s = 1e-3;
  EXPECT_DOUBLE_EQ(read("G4 P1500\nG4 X2\nM2\n", fanuc).duration_s(), 1.5 + 2.0);
}

TEST(NcProgram, NotesWhatItPassesOver) {
  const NcProgram program = read("G54 G0 X1\nG55 X2\nG41 D1 X3\nG40\nG42 X5\nG41 D1\nM2\n");
  EXPECT_THAT(program.notes, ElementsAre(HasSubstr("line 2: G55: this is another coordinate system"),
                                         HasSubstr("line 3: G41: cutter compensation"), HasSubstr("line 5: G42")));
  NcSettings lenient = kSettings;
  lenient.ignored = {"M88", "G187"};
  EXPECT_DOUBLE_EQ(read("G187 P3\nG4 P1\nM88\nM2\n", lenient).duration_s(), 1.0);
}

struct Wrong {
  const char* name;
  const char* text;
  std::vector<const char*> message;
};

class NcErrors : public ::testing::TestWithParam<Wrong> {};

TEST_P(NcErrors, NameLineAndWord) {
  try {
    (void)read(GetParam().text, GetParam().name == std::string("rapid_unknown") ||
                                        GetParam().name == std::string("tool_change_unknown") ||
                                        GetParam().name == std::string("no_machine_zero")
                                    ? NcSettings{}
                                    : kSettings);
    FAIL() << "was accepted";
  } catch (const InputError& e) {
    for (const char* part : GetParam().message) EXPECT_THAT(e.what(), HasSubstr(part));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, NcErrors,
    ::testing::Values(
        Wrong{"unknown_g", "G0 X1\nG1 X2 G77\nM2\n", {"nc_program_test.ngc:2:7: G77: ", "ignore", "    2 | G1 X2 G77"}},
        Wrong{"spline", "G5.1 X1 I1 J2\nM2\n", {"G5.1: splines"}},
        Wrong{"no_number", "G1 X\nM2\n", {":1:4: 'X' is no word"}},
        Wrong{"two_points", "G1 X1.2.3\nM2\n", {"'X1.2.3' is no word"}},
        Wrong{"no_letter", "G1 X1 *3\nM2\n", {"'*' is not allowed here"}},
        Wrong{"open_comment", "G1 X1 (oh\nM2\n", {":1:7: the comment does not end"}},
        Wrong{"no_feed", "G1 X1\nM2\n", {":1:1: the feed move has no feed"}},
        Wrong{"feed_zero", "G1 X1 F0\nM2\n", {"the feed move has no feed"}},
        Wrong{"feed_forgotten", "G1 X1 F100\nG95 S100 M3 X2\nM2\n", {":2:1: the feed move has no feed"}},
        Wrong{"inverse_time_without_f", "G93 G1 X1 F2\nX2\nM2\n", {":2:1: the feed move has no F; with G93"}},
        Wrong{"feed_negative", "G1 X1 F-5\nM2\n", {"F-5: the value must be zero or above"}},
        Wrong{"per_revolution_at_rest", "G95 S100\nG1 X1 F0.1\nM2\n", {":2:1: ", "the spindle is at rest"}},
        Wrong{"rapid_unknown", "G0 X1\nM2\n", {"state `rapid`"}},
        Wrong{"tool_change_unknown", "T1 M6\nM2\n", {"state `tool_change`"}},
        Wrong{"no_machine_zero", "G28\nM2\n", {"G28 needs the machine's zero"}},
        Wrong{"no_end", "G4 P1\n", {"the program has no end"}},
        Wrong{"contradiction", "G0 G1 X1\nM2\n", {":1:4: G1: it contradicts G0"}},
        Wrong{"cycle_and_its_end", "G80 G81 X1 Z-5 R1 F100\nM2\n", {":1:5: G81: it contradicts G80 in the same block"}},
        Wrong{"cycle_end_and_cycle", "G83 G80 X1\nM2\n", {":1:5: G80: it contradicts G83 in the same block"}},
        Wrong{"contradiction_beside_g80", "G0 G80 G1 X1\nM2\n", {":1:8: G1: it contradicts G0"}},
        Wrong{"axis_words_in_the_block_of_g80", "G80 X5\nM2\n", {":1:1: axis words come after G80"}},
        Wrong{"scaling_off_with_axis_words", "G0 G50 X5\nM2\n", {"G50: with other words in its block", "without S, X"}},
        Wrong{"limit_of_speed", "G50 S2000\nM2\n", {"G50: with other words in its block"}},
        Wrong{"mirror_off_with_axis_words", "G50.1 X0 Y0\nM2\n", {"G50.1: with other words in its block"}},
        Wrong{"twice", "G0 X1 X2\nM2\n", {":1:7: X2: a second X"}},
        Wrong{"unused", "G0 X1 Q3\nM2\n", {":1:7: Q3: this word has no use"}},
        Wrong{"rotary", "G0 A90\nM2\n", {"A90: rotary"}},
        Wrong{"no_motion_word", "X5\nM2\n", {"axis words come before any motion word"}},
        Wrong{"after_g80", "G80\nX5\nM2\n", {":2:1: axis words come after G80"}},
        Wrong{"arc_without_centre", "G2 X5 F100\nM2\n", {"the arc has no centre; write I or J (plane G17)"}},
        Wrong{"arc_with_k", "G2 X5 K1 F100\nM2\n", {"the arc has no centre"}},
        Wrong{"arc_radii_differ",
              "G2 X10 Y1 I4 F100\nM2\n",
              {"starts 4.0000 mm from its centre and ends 6.0828 mm", "up to 0.0283 mm is allowed"}},
        Wrong{"arc_ends_at_centre", "G2 X0.01 I0.01 F100\nM2\n", {"radius zero at its end"}},
        Wrong{"arc_radius_zero", "G2 X0 Y0 I0 F100\nM2\n", {"radius zero"}},
        Wrong{"arc_r_too_small", "G2 X10 R4 F100\nM2\n", {"cannot reach a point 10.0000 mm away", "at least 4.9879 mm"}},
        Wrong{"arc_r_whole", "G2 X0 R4 F100\nM2\n", {"written with I, J, K"}},
        Wrong{"arc_turns", "G2 I4 P1.5 F100\nM2\n", {"P1.5: the value must be a whole number"}},
        Wrong{"dwell_without_time", "G4\nM2\n", {"G4 has no time"}},
        Wrong{"dwell_negative", "G4 P-1\nM2\n", {"P-1: the value must be zero or above"}},
        Wrong{"cycle_without_r", "G81 X1 Z-5 F100\nM2\n", {"G81 requires Z, R"}},
        Wrong{"cycle_without_q", "G83 X1 Z-5 R1 F100\nM2\n", {"requires Z, R, Q"}},
        Wrong{"cycle_upward", "G81 X1 Z5 R1 F100\nM2\n", {"bottom lies above its R level"}},
        Wrong{"cycle_negative_peck", "G83 X1 Z-5 R1 Q-1 F100\nM2\n", {"Q, must be above zero"}},
        Wrong{"cycle_inverse_time", "G93\nG81 X1 Z-5 R1 F100\nM2\n", {"a canned cycle is not allowed with G93"}},
        Wrong{"cycle_without_axis", "G81 R1 F100\nM2\n", {"the canned cycle has no axis words"}}),
    [](const auto& wrong) { return std::string(wrong.param.name); });

TEST(NcProgram, AMissingFileIsNamed) {
  EXPECT_REFUSED(read_nc_program("/nowhere/a.ngc", kSettings), "/nowhere/a.ngc", "cannot be opened");
}

class Merging : public ::testing::TestWithParam<double> {};

TEST_P(Merging, KeepsTimeTravelTurnsAndWork) {
  const NcProgram program = read_nc_program("scenarios/parts/pocket.ngc", kSettings);
  const int times = 7;
  const double power_W = 350.0;
  const auto sections = repeated(merged_sections(program.moves, GetParam(), power_W), times);
  double duration_s = 0.0, turns = 0.0, work_J = 0.0, cutting_s = 0.0;
  std::array<double, 3> travel = {0, 0, 0};
  for (const Cyclogram::Section& s : sections) {
    duration_s += s.duration_s;
    turns += s.drive.speed_rpm / 60.0 * s.duration_s;
    work_J += s.drive.cutting_power_W * s.duration_s;
    for (int axis = 0; axis < 3; ++axis) travel[axis] += 1e3 * s.drive.feed_m_s[axis] * s.duration_s;
  }
  for (const NcMove& m : program.moves) cutting_s += m.cutting ? m.duration_s : 0.0;
  // Conservation to 1e-9 is the claim; the sums themselves round at about 1e-13.
  EXPECT_NEAR(duration_s / (times * program.duration_s()), 1.0, 1e-9);
  EXPECT_NEAR(turns / (times * revolutions(program)), 1.0, 1e-9);
  EXPECT_NEAR(work_J / (times * power_W * cutting_s), 1.0, 1e-9);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(travel[axis] / (times * travel_mm(program)[axis]), 1.0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Resolutions, Merging, ::testing::Values(0.0, 0.5, 10.0, 1000.0));

TEST(Merging, LeavesLongMovesAndPulsesOfTheSpindleAlone) {
  // A pulse of 30 s between standstills of an hour, and two short moves around a long one at one speed.
  const NcProgram program = read(
      "G4 P3600\nS1000 M3\nG4 P30\nM5\nG4 P3600\nM3\n"
      "G1 X10 F600\nX15\nG1 Y200\nG1 Z2\nM2\n");
  const auto sections = merged_sections(program.moves, 10.0, 0.0);
  std::vector<double> duration_s, speed_rpm;
  for (const auto& s : sections) {
    duration_s.push_back(s.duration_s);
    speed_rpm.push_back(s.drive.speed_rpm);
  }
  EXPECT_THAT(duration_s, ElementsAre(3600.0, 30.0, 3600.0, 1.5, 20.0, DoubleNear(0.2, 1e-12)));
  EXPECT_THAT(speed_rpm, ElementsAre(0.0, 1000.0, 0.0, 1000.0, 1000.0, 1000.0));
}

TEST(Merging, MakesMeansOfFeedAndPower) {
  // 1 s of feed at 10 mm/s along x, then a rapid of 0.1 s along z: 25 mm. Then 20 s of feed along y, left alone.
  const NcProgram program = read("S1000 M3\nG1 X10 F600\nG0 Z25\nG1 Y200\nM2\n");
  const auto sections = merged_sections(program.moves, 10.0, 110.0);
  ASSERT_EQ(sections.size(), 2u);
  EXPECT_NEAR(sections[0].duration_s, 1.1, 1e-12);
  EXPECT_NEAR(sections[0].drive.feed_m_s[0], 0.010 / 1.1, 1e-12);
  EXPECT_NEAR(sections[0].drive.feed_m_s[2], 0.025 / 1.1, 1e-12);
  EXPECT_NEAR(sections[0].drive.cutting_power_W, 100.0, 1e-9);
  EXPECT_NEAR(sections[1].drive.feed_m_s[1], 0.010, 1e-12);
  EXPECT_EQ(sections[1].drive.cutting_power_W, 110.0);
}

// --- where the axes are -------------------------------------------------------------------------------------------

TEST(NcPositions, AreRangesWithinRowsOfTheResolution) {
  // A rapid of 100 mm in 0.4 s, 300 mm at 50 mm/s in three rows of 2 s, a dwell, and back; counted from 50 mm.
  for (const std::string& back : {std::string("G1 X100\n"), std::string("G92 X0\nG1 X-300\n")}) {
    const auto columns =
        position_columns(read("G21 G90\nG0 X100\nG1 X400 F3000\nG4 P2\n" + back + "M2\n"), 2.0, {0.05, 0.0, 0.5});
    ASSERT_EQ(columns.size(), 6u);
    EXPECT_EQ(columns[0].header(), "position_x_mm");
    EXPECT_EQ(columns[1].header(), "stroke_x_mm");
    const auto near = [](double x) { return DoubleNear(x, 1e-9); };
    EXPECT_THAT(columns[0].rows.time_s,
                ElementsAre(near(0), near(0.4), near(2.4), near(4.4), near(6.4), near(8.4), near(10.4), near(12.4)));
    EXPECT_THAT(columns[0].rows.value,
                ElementsAre(near(0), near(100), near(200), near(300), near(350), near(300), near(200), near(100)));
    EXPECT_THAT(columns[1].rows.value,
                ElementsAre(near(100), near(100), near(100), near(100), near(0), near(100), near(100), near(100)));
    EXPECT_THAT(columns[4].rows.value.back(), near(-500));  // Z has not moved
  }
  // A full circle of 40 mm about X20: 0 to 40 mm, in one row.
  const auto circle = position_columns(read("G21 G90 G17\nG2 X0 Y0 I20 J0 F600\nM2\n"), 2.0, {0.0, 0.0, 0.0});
  EXPECT_THAT(circle[0].rows.value, ElementsAre(DoubleNear(20.0, 1e-9)));
  EXPECT_THAT(circle[1].rows.value, ElementsAre(DoubleNear(40.0, 1e-9)));
}

}  // namespace
}  // namespace driftwright::nc_program_test
