// Programs as Siemens and Heidenhain controls write them: times and travels by hand, one part in five languages, mistakes
// by their line. Most of it is the table of these programs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "nc/correction.hpp"
#include "nc/places.hpp"
#include "nc/program.hpp"
#include "tests/nc/program_sums.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::nc_languages_test {
namespace {

using fixtures::on_line, fixtures::revolutions, fixtures::travel_mm;
using ::testing::AllOf, ::testing::ElementsAre, ::testing::HasSubstr, ::testing::ThrowsMessage;

constexpr double kPi = std::numbers::pi;
constexpr double kRounding = 1e-12;  // relative: sums of a few dozen terms of one sign in double precision

NcProgram read(const std::string& text, const std::string& control) {
  const NcSettings settings{.rapid_m_s = 0.25,  // 15 m/min
                            .tool_change_s = 8.0,
                            .dwell_P_s = 1.0,
                            .machine_zero_m = std::array<double, 3>{0.0, 0.0, 0.5},
                            .ignored = {},
                            .control = control};
  return read_nc_program(write_file("nc_languages_test.txt", text), settings);
}

struct Timed {
  const char* name;
  const char* control;
  std::string text;
  double seconds;
  std::array<double, 3> travel;  ///< mm
  double revolutions;
};

class NcLanguages : public ::testing::TestWithParam<Timed> {};

TEST_P(NcLanguages, TakeTheTimesComputedByHand) {
  const NcProgram program = read(GetParam().text, GetParam().control);
  EXPECT_NEAR(program.duration_s(), GetParam().seconds, kRounding * GetParam().seconds);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(travel_mm(program)[axis], GetParam().travel[axis], 1e-9) << "axis " << axis;
  EXPECT_NEAR(revolutions(program), GetParam().revolutions, 1e-9);
}

std::string klartext(const std::string& blocks) {
  return "BEGIN PGM T MM\n" + blocks + "END PGM T MM\n";
}

std::string din(const std::string& blocks) {
  return "%T G71 *\n" + blocks + "N99999 %T G71 *\n";
}

constexpr const char *kS = "siemens", *kH = "heidenhain";

INSTANTIATE_TEST_SUITE_P(
    Siemens, NcLanguages,
    ::testing::Values(
        Timed{"units_comments_messages",
              kS,
              "%_N_PART_MPF\n;$PATH=/_N_MPF_DIR\nN10 MSG(\"first (side)\")\nN20 G17 G54 G71 G90 G94 ; mm\nN30 S1=1200 "
              "M1=3\nN40 G1 X50 F600\nY50\nN50 M5\nM30\n",
              10,
              {50, 50, 0},
              200},
        // G70: lengths in inch, the feed still in mm/min; G700: both in inch.
        Timed{"inch_lengths", kS, "G70 G90\nG1 X1 F254\nG700\nX2 F10\nM30\n", 6 + 6, {50.8, 0, 0}, 0},
        Timed{"dwells", kS, "G71\nS60 M3\nG4 F2.5\nG4 S3\nM30\n", 5.5, {0, 0, 0}, 5.5},
        Timed{"incremental_words",
              kS,
              "G71 G90\nG1 X=IC(10) F600\nX=IC(10) Y5\nG91 X=AC(0) Y-5\nM2\n",
              1 + std::hypot(10.0, 5.0) / 10 + std::hypot(20.0, 5.0) / 10,
              {40, 10, 0},
              0},
        Timed{"arcs",
              kS,
              "G71 G90\nG2 X10 Y10 I10 J0 F600\nG3 X0 Y0 I=AC(10) J=AC(0)\nG2 X10 Y10 CR=10\nM30\n",
              3 * kPi / 2,
              {30, 30, 0},
              0},
        // Two turns more: r = 3 mm, three turns in all, rise 4 x 6 pi: length hypot(18 pi, 24 pi) = 30 pi.
        Timed{"helix", kS, "G710 G90\nG2 I3 J0 Z-75.39822368615503 TURN=2 F600\nM30\n", 3 * kPi, {36, 36, 24 * kPi}, 0},
        Timed{"feed_of_one_block", kS, "G71\nG1 X10 F600\nX20 FB=1200\nX30\nM30\n", 2.5, {30, 0, 0}, 0},
        Timed{"parameters_and_loops",
              kS,
              "G71 G90\nDEF INT N=0\nR1=0 R2=2*5\nF600\nAGAIN: G1 X=R2 \nX0\nR1=R1+1\nIF R1<3 GOTOB AGAIN\nWHILE "
              "N<2\nN=N+1\nG1 Y=N*10\nENDWHILE\n"
              "FOR R3=1 TO 2\nG91 G1 Z-1\nG90\nENDFOR\nIF R1==3\nG4 F1\nELSE\nG4 F100\nENDIF\nM30\n",
              6 + 2 + 0.2 + 1,
              {60, 20, 2},
              0},
        Timed{"repeat_a_part",
              kS,
              "G71 G90 F600\nFROM: G1 X10\nX0\nTO: G4 F1\nREPEAT FROM TO P=2\nM30\n",
              3 * (2 + 1),
              {60, 0, 0},
              0},
        Timed{"shifts_of_the_origin",
              kS,
              "G71 G90\nG0 X50\nTRANS X50\nG1 X10 F600\nATRANS X10\nX0\nTRANS\nX50\nM30\n",
              50.0 / 250 + 1 + 0 + 1,
              {70, 0, 0},
              0},
        Timed{"machine_coordinates", kS, "G71 G90\nG0 Z100\nSUPA G0 Z0\nM30\n", 100.0 / 250 + 400.0 / 250, {0, 0, 500}, 0},
        // From 50 to 2 (reference 0, clearance 2), to -10 at 5 mm/s, 1 s at the bottom, out to 50.
        Timed{"drilling",
              kS,
              "G71 G90 F300\nG0 Z50\nCYCLE82(50,0,2,-10,,1)\nM30\n",
              50.0 / 250 + 48.0 / 250 + 12.0 / 5 + 1 + 60.0 / 250,
              {0, 0, 50 + 48 + 12 + 60},
              0},
        Timed{"drilling_at_each_place",
              kS,
              "G71 G90 F300\nG0 Z2\nMCALL CYCLE81(2,0,2,,10)\nX10\nX20\nMCALL\nX0\nM30\n",
              2.0 / 250 + 2 * (10.0 / 250 + 12.0 / 5 + 12.0 / 250) + 20.0 / 250,
              {40, 0, 2 + 48},
              0},
        // Depths 6 and then 10: the amount 6 shrinks by 2 to 4. To clear: out to 2, back to 0.6 above, which is fed once
        // more.
        Timed{"deep_drilling",
              kS,
              "G71 G90 F300\nG0 Z2\nCYCLE83(2,0,2,-10,,,6,2,0,0,1,1)\nM30\n",
              2.0 / 250 + (2 + 6 + 0.6 + 4) / 5 + (8 + 7.4 + 12) / 250,
              {0, 0, 2 + 12.6 + 27.4},
              0},
        // Pitch 1.5 mm at 300 rpm: 7.5 mm/s in and out.
        Timed{"tapping", kS, "G71 G90\nS300\nG331 Z-15 K1.5\nG332 Z0 K1.5\nM30\n", 4, {0, 0, 30}, 20},
        Timed{"iso_mode", kS, "G291\nG21 G90 (ISO)\nO0001\nG1 X50 F600\nM30\n", 5, {50, 0, 0}, 0}),
    [](const auto& timed) { return std::string(timed.param.name); });

INSTANTIATE_TEST_SUITE_P(
    HeidenhainIso, NcLanguages,
    ::testing::Values(
        Timed{"program",
              kH,
              "%NEW G71 *\nN10 G30 G17 X+0 Y+0 Z-20 *\nN20 G31 G90 X+100 Y+100 Z+0 *\nN30 G99 T1 L+0 R+5 *\nN40 T1 G17 "
              "S1200 *\n"
              "N50 G00 G40 G90 Z+50 M03 *\nN60 G01 X+50 F600 *\nN70 Y+50 *\nN80 G04 F2 *\nN90 G00 Z+0 M2 *\nN99999999 %NEW "
              "G71 *\n",
              8 + 0.2 + 5 + 5 + 2 + 0.2,
              {50, 50, 100},
              20 * (0.2 + 5 + 5 + 2 + 0.2)},
        // I, J are the pole in absolute coordinates; a quarter of r = 10 about (10, 0).
        Timed{"arcs",
              kH,
              din("N1 G90 G01 X+0 Y+0 F600 *\nN2 I+10 J+0 *\nN3 G02 X+10 Y+10 *\nN4 G03 X+0 Y+0 I+10 J+0 *\nN5 G02 X+10 "
                  "Y+10 R+10 *\n"),
              3 * kPi / 2,
              {30, 30, 0},
              0},
        Timed{"polar",
              kH,
              din("N1 G90 I+0 J+0 *\nN2 G11 R+10 H+0 F600 *\nN3 G13 H+90 *\nN4 G13 G91 H+360 Z-5 *\n"),
              1 + kPi / 2 + std::hypot(20 * kPi, 5.0) / 10,
              {10 + 10 + 40, 10 + 40, 5},
              0},
        Timed{"incremental_from_its_place_on",
              kH,
              din("N1 G90 G01 X+10 G91 Y+5 F600 *\nN2 X+10 *\nN3 G90 X+0 Y+0 *\n"),
              std::hypot(10.0, 5.0) / 10 + 1 + std::hypot(20.0, 5.0) / 10,
              {40, 10, 0},
              0},
        Timed{"labels",
              kH,
              din("N1 G90 F600 *\nN2 G98 L1 *\nN3 G01 G91 X+10 *\nN4 L1,2 *\nN5 G90 L2,0 *\nN6 G01 Z+10 M2 *\nN7 G98 L2 "
                  "*\nN8 G01 Y+10 *\nN9 G98 L0 *\n"),
              3 + 1 + 1,
              {30, 10, 10},
              0},
        Timed{"parameters",
              kH,
              din("N1 D00 Q1 P01 +5 *\nN2 D03 Q2 P01 +Q1 P02 +2 *\nN3 G01 G90 X+Q2 FQ3 *\n")
                  .replace(0, 9, "%T G71 *\nN0 Q3 = 100 * 6\n"),
              1,
              {10, 0, 0},
              0},
        // Clearance 2, depth 10 in two of 5: down 7 from 2, back to 2, to 2 above the first depth, down 7, 1 s, out to 50.
        Timed{"drilling",
              kH,
              din("N1 G00 G90 Z+50 *\nN2 G200 Q200=2 Q201=-10 Q206=300 Q202=5 Q210=0.5 Q203=+0 Q204=50 Q211=1 *\nN3 X+10 "
                  "M99 *\n"),
              50.0 / 250 + 10.0 / 250 + 48.0 / 250 + 7.0 / 5 + 7.0 / 250 + 0.5 + 5.0 / 250 + 7.0 / 5 + 1 + 12.0 / 250 +
                  48.0 / 250,
              {10, 0, 50 + 48 + 7 + 7 + 5 + 7 + 12 + 48},
              0},
        Timed{"datum_shift",
              kH,
              din("N1 G00 G90 X+50 *\nN2 G54 X+50 *\nN3 G01 X+10 F600 *\nN4 G54 X+0 *\nN5 X+50 *\n"),
              50.0 / 250 + 1 + 1,
              {70, 0, 0},
              0}),
    [](const auto& timed) { return std::string(timed.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Klartext, NcLanguages,
    ::testing::Values(
        Timed{"program",
              kH,
              "0 BEGIN PGM NEW MM\n1 BLK FORM 0.1 Z X+0 Y+0 Z-20\n2 BLK FORM 0.2 X+100 Y+100 Z+0\n* - ROUGHING\n3 TOOL CALL "
              "1 Z S1200 F600\n"
              "4 L Z+50 R0 FMAX M3\n5 L X+50 F AUTO ; there\n6 L IY+50\n7 CYCL DEF 9.0 DWELL TIME\n8 CYCL DEF 9.1 DWELL "
              "2\n9 L Z+0 FMAX M30\n10 END PGM NEW MM\n",
              8 + 0.2 + 5 + 5 + 2 + 0.2,
              {50, 50, 100},
              20 * (0.2 + 5 + 5 + 2 + 0.2)},
        Timed{"arcs",
              kH,
              klartext("L X+0 Y+0 F600\nCC X+10 Y+0\nC X+10 Y+10 DR-\nC X+0 Y+0 DR+\nCR X+10 Y+10 R+10 DR-\n"),
              3 * kPi / 2,
              {30, 30, 0},
              0},
        Timed{"polar_and_helix",
              kH,
              klartext("CC X+0 Y+0\nLP PR+10 PA+0 F600\nCP PA+90 DR+\nCP IPA+720 IZ-5 DR+\n"),
              1 + kPi / 2 + std::hypot(40 * kPi, 5.0) / 10,
              {10 + 10 + 80, 10 + 80, 5},
              0},
        // After a line along x, a tangential half circle of r = 10 comes back 20 above.
        Timed{"tangential", kH, klartext("L X+30 F600\nCT X+30 Y+20\n"), 3 + kPi, {30 + 20, 20, 0}, 0},
        Timed{
            "labels",
            kH,
            klartext("LBL 1\nL IX+10 F600\nCALL LBL 1 REP2\nCALL LBL \"HOLE\"\nL Z+10\nM30\nLBL \"HOLE\"\nL Y+10\nLBL 0\n"),
            3 + 1 + 1,
            {30, 10, 10},
            0},
        Timed{"parameters",
              kH,
              klartext("Q1 = 0\nFN 0: Q2 = +10\nLBL 5\nL X+Q2 F600\nL X+0\nFN 1: Q1 = +Q1 + +1\nFN 12: IF +Q1 LT +3 GOTO "
                       "LBL 5\nQ4 = SQRT 100 * SIN 90\nL Y+Q4\n"),
              6 + 1,
              {60, 10, 0},
              0},
        Timed{"drilling",
              kH,
              klartext("L Z+50 FMAX\nCYCL DEF 200 DRILLING ~\n   Q200=2 ;SET-UP CLEARANCE ~\n   Q201=-10 ;DEPTH ~\n   "
                       "Q206=+300 ~\n   Q202=+5 ~\n   Q210=+0,5 ~\n"
                       "   Q203=+0 ~\n   Q204=+50 ~\n   Q211=+1\nL X+10 R0 FMAX M99\n"),
              50.0 / 250 + 10.0 / 250 + 48.0 / 250 + 7.0 / 5 + 7.0 / 250 + 0.5 + 5.0 / 250 + 7.0 / 5 + 1 + 12.0 / 250 +
                  48.0 / 250,
              {10, 0, 50 + 48 + 7 + 7 + 5 + 7 + 12 + 48},
              0},
        Timed{"datum_shift",
              kH,
              klartext("L X+50 FMAX\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+40\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 "
                       "IX+10\nL X+10 F600\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+0\nL X+50\n"),
              50.0 / 250 + 1 + 1,
              {70, 0, 0},
              0},
        Timed{"machine_coordinates",
              kH,
              klartext("L Z+100 FMAX\nL Z+0 FMAX M91\nM140 MB MAX\n"),
              100.0 / 250 + 400.0 / 250,
              {0, 0, 500},
              0},
        Timed{"inches", kH, "BEGIN PGM T INCH\nL X+1 F100\nEND PGM T INCH\n", 6, {25.4, 0, 0}, 0},
        Timed{"rigid_tapping",
              kH,
              klartext("TOOL CALL 2 Z S300\nL Z+2 FMAX M3\nCYCL DEF 207 RIGID TAPPING Q200=2 Q201=-13 Q239=+1.5 Q203=+0 "
                       "Q204=+2\nCYCL CALL\n"),
              8 + 2.0 / 250 + 4,
              {0, 0, 32},
              5 * (2.0 / 250 + 4)}),
    [](const auto& timed) { return std::string(timed.param.name); });

// One part, five languages: the moves of all are those of the program for LinuxCNC.
TEST(NcLanguages, MakeTheSameMovesOfOnePart) {
  const NcProgram linuxcnc = read(
      "G21 G90 G17 G54\nT1 M6\nS2000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X80 F400\nG3 X90 Y10 I0 J10\nG1 Y40\nG2 X80 Y50 I0 "
      "J10\nG1 X0\nG4 P2\nG0 Z5\nM5\nM30\n",
      "linuxcnc");
  const std::vector<std::pair<const char*, std::string>> others = {
      {kS,
       "G71 G90 G17 G54\nT1 M6\nS2000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X80 F400\nG3 X90 Y10 I0 J10\nG1 Y40\nG2 X80 Y50 "
       "CR=10\nG1 X0\nG4 F2\nG0 Z5\nM5\nM30\n"},
      {kS,
       "G291\nG21 G90 G17 G54\nT1 M6\nS2000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X80 F400\nG3 X90 Y10 I0 J10\nG1 Y40\nG2 X80 "
       "Y50 I0 J10\nG1 X0\nG4 P2\nG0 Z5\nM5\nM30\n"},
      {kH,
       "%T G71 *\nN1 T1 G17 S2000 *\nN2 G00 G40 G90 X+0 Y+0 Z+5 M3 *\nN3 G01 Z-1 F100 *\nN4 X+80 F400 *\nN5 I+80 J+10 *\nN6 "
       "G03 X+90 Y+10 *\nN7 G01 Y+40 *\n"
       "N8 G02 X+80 Y+50 I+90 J+50 *\nN9 G01 X+0 *\nN10 G04 F2 *\nN11 G00 Z+5 *\nN12 M5 *\nN99 %T G71 *\n"},
      {kH, klartext("TOOL CALL 1 Z S2000\nL X+0 Y+0 Z+5 R0 FMAX M3\nL Z-1 F100\nL X+80 F400\nCC X+80 Y+10\nC X+90 Y+10 "
                    "DR+\nL Y+40\nCR X+80 Y+50 R+10 DR-\nL X+0\n"
                    "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 2\nL Z+5 FMAX\nM5\n")}};
  for (const auto& [control, text] : others) {
    const NcProgram other = read(text, control);
    ASSERT_EQ(other.moves.size(), linuxcnc.moves.size()) << text;
    for (std::size_t i = 0; i < other.moves.size(); ++i) {
      EXPECT_NEAR(other.moves[i].duration_s, linuxcnc.moves[i].duration_s, 1e-12) << i << "\n" << text;
      EXPECT_EQ(other.moves[i].speed_rpm, linuxcnc.moves[i].speed_rpm) << i << "\n" << text;
      EXPECT_EQ(other.moves[i].cutting, linuxcnc.moves[i].cutting) << i << "\n" << text;
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(other.moves[i].travel_m[axis], linuxcnc.moves[i].travel_m[axis], 1e-12) << i << "\n" << text;
    }
  }
}

// Numbers that are rounded to 0.01 mm or 0.001 in: radii at start and end differ by 0.028 mm and 0.0028 in, which is just
// what rounding may come to.
TEST(NcLanguages, AllowTheRoundingOfArcsAlike) {
  const auto inch = [](const std::string& blocks) { return "BEGIN PGM T INCH\n" + blocks + "END PGM T INCH\n"; };
  const std::vector<std::pair<const char*, std::string>> programs = {
      {kS, "G71 G90\nG2 X4.0# I2 J0 F600\nM30\n"},
      {kS, "G71 G90\nG2 X4.0# I=AC(2) J=AC(0) F600\nM30\n"},
      {kS, "G700 G90\nG2 X0.40# I0.2 J0 F60\nM30\n"},
      {kS, "G291\nG21 G90\nG2 X4.0# I2 J0 F600\nM30\n"},
      {kH, din("N1 G90 I+2 J+0 *\nN2 G02 X+4.0# Y+0 F600 *\n")},
      {kH, klartext("CC X+2 Y+0\nC X+4.0# Y+0 DR- F600\n")},
      {kH, klartext("CC X+2 Y+0\nCP PR+2.0# PA+0 DR- F600\n")},
      {kH, inch("CC X+0,2 Y+0\nC X+0,40# Y+0 DR- F600\n")}};
  for (const auto& [control, text] : programs) {
    const auto with = [&](const std::string& digits) { return std::string(text).replace(text.find('#'), 1, digits); };
    EXPECT_GT(read(with("28"), control).duration_s(), 0.0) << text;
    EXPECT_REFUSED(read(with("29"), control), "is allowed") << text;
  }
  // Half of the chord is longer than the radius by 0.012 mm.
  const std::vector<std::pair<const char*, std::string>> radii = {{kS, "G71 G90\nG2 X4.02# CR=2 F600\nM30\n"},
                                                                  {kH, din("N1 G90 G02 X+4.02# Y+0 R+2 F600 *\n")},
                                                                  {kH, klartext("CR X+4.02# Y+0 R+2 DR- F600\n")}};
  for (const auto& [control, text] : radii) {
    const auto with = [&](const std::string& digits) { return std::string(text).replace(text.find('#'), 1, digits); };
    EXPECT_NEAR(read(with("4"), control).duration_s(), kPi * 2.012 / 10, 1e-9) << text;
    EXPECT_REFUSED(read(with("5"), control), "cannot reach") << text;
  }
}

// First blocks as posts write them.
TEST(NcLanguages, ReadTheUsualFirstBlocks) {
  for (const char* first : {"G17 G40 G54 G60 G64 G71 G90 G94", "G0 G40 G90 G17 G54 G64 G71 SOFT FFWON",
                            "G90 G94 G710 G40 G17 G500 CFC", "N10 G64 G40 G17 G71 G94 G97", "G290\nG17 G90 G71 G40 G601"}) {
    EXPECT_NEAR(read(std::string(first) + "\nG71 G0 X25\nG4 F1\nM30\n", kS).duration_s(), 0.1 + 1, 1e-12) << first;
  }
  for (const char* first :
       {"G17 G21 G40 G49 G80 G90", "G0 G17 G20 G40 G49 G50 G69 G80 G90 G94 G98", "G80 G0 G40 G49 G15 G67 G97"}) {
    EXPECT_NEAR(read(std::string("G291\n") + first + "\nG21 G0 X25\nG4 P1\nM30\n", kS).duration_s(), 0.1 + 1, 1e-12)
        << first;
  }
  for (const char* first : {"N10 G40 G90 *", "N10 G00 G17 G40 G90 G71 *", "N10 G90 G80 G40 *"}) {
    const std::string text = din(std::string(first) + "\nN20 G00 X+25 *\nN30 G04 F1 *\n");
    if (std::string(first).find("G80") != std::string::npos) {  // no word of this control
      EXPECT_THROW((void)read(text, kH), InputError) << first;
    } else {
      EXPECT_NEAR(read(text, kH).duration_s(), 0.1 + 1, 1e-12) << first;
    }
  }
}

struct Mistaken {
  const char* name;
  const char* control;
  std::string text;
  std::vector<const char*> message;
};

class NcLanguageErrors : public ::testing::TestWithParam<Mistaken> {};

TEST_P(NcLanguageErrors, NameTheLine) {
  try {
    (void)read(GetParam().text, GetParam().control);
    FAIL() << "was accepted";
  } catch (const InputError& e) {
    for (const char* part : GetParam().message) EXPECT_THAT(e.what(), HasSubstr(part));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, NcLanguageErrors,
    ::testing::Values(
        Mistaken{"siemens_comment", kS, "G71\nG1 X1 F100 (side)\nM30\n", {":2:12: '('", "comments follow ';'"}},
        Mistaken{"siemens_o_number", kS, "O0001\nG71\nM30\n", {":1:2:", "O numbers belong to ISO code"}},
        Mistaken{"siemens_iso_unit", kS, "G21 G90\nM30\n", {":1:1: G21:", "G70 and G71"}},
        Mistaken{"siemens_iso_length", kS, "G71\nG43 H1 Z5\nM30\n", {"G43: this is a word of ISO code"}},
        Mistaken{"siemens_subprogram", kS, "G71\nPOCKET_1\nM30\n", {":2:1: POCKET_1 is not known here", "subprogram"}},
        Mistaken{"siemens_endless", kS, "G71\nA1: R1=1\nGOTOB A1\nM30\n", {"has run 500004 blocks"}},
        Mistaken{"siemens_open_loop", kS, "G71\nWHILE 1\nM30\n", {":2:1: WHILE is not closed"}},
        Mistaken{"siemens_unknown_r", kS, "G71\nG1 X=R5 F100\nM30\n", {":2:", "R5 is what the operator"}},
        Mistaken{"siemens_no_label", kS, "G71\nGOTOF AWAY\nM30\n", {":2:7: no label AWAY"}},
        Mistaken{
            "siemens_turns", kS, "G71\nG2 I3 J0 TURN=3000000000 F600\nM30\n", {":2:15: TURN=3000000000", "0 to 100000"}},
        Mistaken{"siemens_part_of_a_turn", kS, "G71\nG2 I3 J0 TURN=0.5 F600\nM30\n", {"TURN=0.5", "whole number"}},
        Mistaken{"siemens_scale", kS, "G71\nSCALE X2\nM30\n", {"scaling is not computed"}},
        Mistaken{"siemens_no_end", kS, "G71\n", {"the program has no end"}},
        Mistaken{"iso_no_unit", kH, "%T\nN1 G00 X+1 *\n", {":1:1: the first line has no unit"}},
        Mistaken{"iso_g20", kH, din("N1 G20 G90 *\n"), {":2:4: G20: this control's inch and mm"}},
        Mistaken{"iso_old_cycle", kH, din("N1 G83 P01 2 *\n"), {"G83: only the drilling cycles G200"}},
        Mistaken{"klartext_no_unit", kH, "BEGIN PGM T\nEND PGM T\n", {":1:1: BEGIN PGM has no unit"}},
        Mistaken{"klartext_pocket", kH, klartext("CYCL DEF 251 RECTANGULAR POCKET Q215=0\n"), {":2:1: CYCL DEF 251"}},
        Mistaken{"klartext_unknown", kH, klartext("PLANE SPATIAL SPA+0 SPB+45 SPC+0 STAY\n"), {"PLANE is not known here"}},
        Mistaken{"klartext_unset_q", kH, klartext("L X+Q8 F100\n"), {":2:1: Q8 is what the operator"}},
        Mistaken{"klartext_no_feed", kH, klartext("L X+8\n"), {"the feed move has no feed"}},
        Mistaken{"klartext_endless", kH, klartext("LBL 1\nFN 9: IF +1 EQU +1 GOTO LBL 1\n"), {"has run 500004 blocks"}},
        Mistaken{"klartext_turns",
                 kH,
                 klartext("CC X+3 Y+0\nCP IPA+1000000000000 DR+ F600\n"),
                 {":3:", "1e+12 degrees", "36000000"}},
        Mistaken{"iso_turns", kH, din("N1 I+3 J+0 *\nN2 G13 G91 H+1000000000000 F600 *\n"), {":3:", "1e+12 degrees"}},
        Mistaken{"klartext_recursion", kH, klartext("LBL 1\nCALL LBL 1\nLBL 0\n"), {"nested more than 8 deep"}}),
    [](const auto& each) { return each.param.name; });

TEST(NcLanguages, KeepUnknownMWordsAndSaySoOnce) {
  for (const auto& [control, text] : std::vector<std::pair<const char*, std::string>>{
           {kS, "G71\nM77\nM77\nG4 F1\nM30\n"},
           {kH, klartext("M77\nM77\nCYCL DEF 9.0 DWELL\nCYCL DEF 9.1 DWELL 1\n")},
           {"linuxcnc", "M77 P3\nM77\nG4 P1\nM2\n"}}) {
    const NcProgram program = read(text, control);
    EXPECT_DOUBLE_EQ(program.duration_s(), 1.0);
    EXPECT_THAT(program.notes, ElementsAre(AllOf(HasSubstr("M77"), HasSubstr("timed as zero")))) << text;
  }
}

// --- corrections in each control's own way
// ----------------------------------------------------------------------------------------

std::string corrected(const std::string& text, const std::string& control, const std::vector<NcOffsetChange>& changes,
                      const std::array<double, 3>& initial_m, bool absolute = false) {
  const NcProgram program = read(text, control);
  const NcOffsetOptions options{.language = program.language,
                                .absolute = absolute,
                                .work_offset = 540,
                                .base_m = {0.1, 0, -0.02},
                                .axes = {true, false, true}};
  std::string result = corrected_nc_program(text, program.steps, initial_m, changes, options).text;
  const std::size_t remark = result.find("driftwright:");  // what it says is another test's
  const std::size_t begin = result.rfind('\n', remark) + 1;
  result.erase(begin, result.find('\n', remark) + 1 - begin);
  return result;
}

TEST(CorrectionsOfSiemens, AreTheBaseFrameThatIsSetAndMore) {
  const std::string text = "N10 G54 G71\nN20 G0 X0 Z5\nN30 G1 Z-1 F100\nN40 X100\nN50 G55\nN60 G0 X0 Z5\nN70 M30\n";
  const std::vector<NcOffsetChange> changes = {{on_line(read(text, kS), 4), 0.5, {{std::nullopt, std::nullopt, 12.5e-6}}}};
  EXPECT_EQ(corrected(text, kS, changes, {-5e-6, 0, 0}),
            "N10 G54 G71\n$P_BFRAME[X,TR]=$P_UBFR[X,TR]-0.005\n$P_BFRAME[Z,TR]=$P_UBFR[Z,TR]\nN20 G0 X0 Z5\nN30 G1 Z-1 "
            "F100\nG1 X50\n"
            "$P_BFRAME[Z,TR]=$P_UBFR[Z,TR]+0.0125\nG1 Z-1\nN40 X100\nN50 G55\n"
            "$P_BFRAME[X,TR]=$P_UBFR[X,TR]-0.005\n$P_BFRAME[Z,TR]=$P_UBFR[Z,TR]+0.0125\nN60 G0 X0 Z5\n"
            "$P_BFRAME[X,TR]=$P_UBFR[X,TR]\n$P_BFRAME[Z,TR]=$P_UBFR[Z,TR]\nN70 M30\n");
  // Only what Siemens language mode knows: no ( ), O, G43, G49, G10, G20, G21.
  const std::string result = corrected(text, kS, changes, {-5e-6, 0, 0});
  for (const char* foreign : {"(", "O", "G43", "G49", "G10", "G20", "G21"}) EXPECT_THAT(result, Not(HasSubstr(foreign)));
  (void)read(text, kS);
}

TEST(CorrectionsOfSiemens, SwitchTheLanguageInIsoMode) {
  const std::string text = "G291\nG21 G54\nG0 X0 Z5\nG1 X100 F100\nM30\n";
  EXPECT_EQ(corrected(text, kS, {}, {0, 0, 1e-5}),
            "G291\nG21 G54\nG290\n$P_BFRAME[X,TR]=$P_UBFR[X,TR]\n$P_BFRAME[Z,TR]=$P_UBFR[Z,TR]+0.01\nG291\nG0 X0 Z5\nG1 "
            "X100 F100\n"
            "G290\n$P_BFRAME[X,TR]=$P_UBFR[X,TR]\n$P_BFRAME[Z,TR]=$P_UBFR[Z,TR]\nG291\nM30\n");
}

TEST(CorrectionsOfHeidenhainIso, AreIncrementsOfTheDatumShift) {
  const std::string text =
      "%T G71 *\r\nN10 G00 G90 X+0 Z+5 *\r\nN20 G01 Z-1 F100 *\r\nN30 X+100 *\r\nN40 G54 X+7 *\r\nN50 X+0 *\r\nN60 M2 "
      "*\r\nN70 %T G71 *\r\n";
  const std::vector<NcOffsetChange> changes = {{on_line(read(text, kH), 4), 0.0, {{-8e-6, std::nullopt, 12.5e-6}}}};
  EXPECT_EQ(corrected(text, kH, changes, {-5e-6, 0, 0}),
            "%T G71 *\r\nN1 G54 G91 X-0.005 *\r\nN2 G90 *\r\nN10 G00 G90 X+0 Z+5 *\r\nN20 G01 Z-1 F100 *\r\n"
            "N21 G54 G91 X-0.003 Z+0.0125 *\r\nN22 G90 *\r\nN23 G01 X+0 Z-1 *\r\nN30 X+100 *\r\nN40 G54 X+7 *\r\n"
            "N41 G54 G91 X-0.008 *\r\nN42 G90 *\r\nN50 X+0 *\r\nN51 G54 G91 X+0.008 Z-0.0125 *\r\nN52 G90 *\r\nN60 M2 "
            "*\r\nN70 %T G71 *\r\n");
}

TEST(CorrectionsOfKlartext, AreIncrementsOfTheDatumShiftInNumberedBlocks) {
  const std::string text =
      "0 BEGIN PGM T MM\n1 TOOL CALL 1 Z S500\n2 L X+0 Z+5 R0 FMAX M3\n3 L Z-1 F100\n4 L X+100\n5 L Z+5 FMAX\n6 M30\n7 END "
      "PGM T MM\n";
  const NcProgram program = read(text, kH);
  const std::vector<NcOffsetChange> changes = {{on_line(program, 5), 0.25, {{-8e-6, std::nullopt, 12.5e-6}}}};
  EXPECT_EQ(nc_entries(program.steps, on_line(program, 6))[2], NcEntry::kAlongRapid);
  EXPECT_EQ(corrected(text, kH, changes, {-5e-6, 0, 0}),
            "0 BEGIN PGM T MM\n1 TOOL CALL 1 Z S500\n3 CYCL DEF 7.0 DATUM SHIFT\n4 CYCL DEF 7.1 IX-0.005\n5 L X+0 Z+5 R0 "
            "FMAX M3\n6 L Z-1 F100\n"
            "7 L X+25\n8 CYCL DEF 7.0 DATUM SHIFT\n9 CYCL DEF 7.1 IX-0.003\n10 CYCL DEF 7.2 IZ+0.0125\n11 L X+25 Z-1\n12 L "
            "X+100\n13 L Z+5 FMAX\n"
            "14 CYCL DEF 7.0 DATUM SHIFT\n15 CYCL DEF 7.1 IX+0.008\n16 CYCL DEF 7.2 IZ-0.0125\n17 M30\n18 END PGM T MM\n");
  // What is written is read again: the same way, and the datum back where it was.
  const NcProgram again = read(corrected(text, kH, changes, {-5e-6, 0, 0}), kH);
  EXPECT_NEAR(again.duration_s(), program.duration_s() + std::hypot(0.003, 0.0125) / (100.0 / 60.0),
              1e-4);  // the step in feed, at F100
  EXPECT_NEAR(again.steps.back().end_m[0], program.steps.back().end_m[0] - 8e-6,
              1e-12);  // it is where the correction has put it
}

TEST(CorrectionsOfHeidenhain, AreAbsoluteWhereThatIsAsked) {
  const std::string text = "%T G71 *\nN1 G00 G90 X+0 Z+5 *\nN2 M2 *\nN3 %T G71 *\n";
  EXPECT_THAT(corrected(text, kH, {}, {-5e-6, 0, 0}, true),
              AllOf(HasSubstr("G54 X+99.995 Z-20 *"), HasSubstr("G54 X+100 Z-20 *")));
}

// A datum shift of the program's own in a part that is run again under another correction cannot be made good by one line.
TEST(CorrectionsOfHeidenhain, RefuseAResetThatIsRunUnderSeveralCorrections) {
  const std::string text = klartext(
      "CALL LBL 2\nL X+0 Z+5 FMAX\nCALL LBL 2\nM30\nLBL 2\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+5\nL X+9 FMAX\nLBL 0\n");
  const NcProgram program = read(text, kH);
  const std::vector<NcOffsetChange> changes = {{on_line(program, 3), 0.0, {{1e-5, std::nullopt, std::nullopt}}}};
  EXPECT_THAT(
      [&] {
        (void)corrected(text, kH, changes, {0, 0, 0});
      },
      ThrowsMessage<InputError>(AllOf(HasSubstr(":7:"), HasSubstr("run again"))));
}

// While a mirror is on, a modal cycle waits or a part is run more than once, no line of ours is inserted.
TEST(NcLanguages, KnowWhereNoLineMayStand) {
  const NcProgram mirrored = read(din("N1 G00 G90 X+0 *\nN2 G28 X *\nN3 X+5 *\nN4 G28 *\nN5 X+0 *\nN6 Z+5 *\n"), kH);
  EXPECT_EQ(nc_entries(mirrored.steps, on_line(mirrored, 4))[0], NcEntry::kNever);
  EXPECT_EQ(nc_entries(mirrored.steps, on_line(mirrored, 6))[0], NcEntry::kAlongRapid);
  const NcProgram modal = read("G71 G90 F100\nG0 X0 Z5\nMCALL CYCLE81(5,0,2,-3)\nX5\nMCALL\nX9\nM30\n", kS);
  EXPECT_EQ(nc_entries(modal.steps, on_line(modal, 4))[0], NcEntry::kNever);
  EXPECT_EQ(nc_entries(modal.steps, on_line(modal, 6))[0], NcEntry::kAlongRapid);
  const NcProgram repeated = read(klartext("LBL 1\nL X+10 FMAX\nL X+0 FMAX\nCALL LBL 1 REP 2\nL X+5 FMAX\n"), kH);
  EXPECT_EQ(nc_entries(repeated.steps, on_line(repeated, 4))[0], NcEntry::kNever);
  EXPECT_EQ(nc_entries(repeated.steps, on_line(repeated, 6))[0], NcEntry::kAlongRapid);
}

}  // namespace
}  // namespace driftwright::nc_languages_test
