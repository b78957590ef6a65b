// Offsets put into NC programs: where they are allowed, and every byte that is written.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nc/correction.hpp"
#include "nc/places.hpp"
#include "nc/program.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::nc_correction_test {
namespace {

using ::testing::ElementsAre, ::testing::HasSubstr, ::testing::ThrowsMessage;

std::vector<NcStep> steps_of(const std::string& text) {
  const NcSettings settings{.rapid_m_s = 0.25,
                            .tool_change_s = 8.0,
                            .dwell_P_s = 1.0,
                            .machine_zero_m = std::array<double, 3>{0.0, 0.0, 0.5},
                            .ignored = {}};
  return read_nc_program(write_file("nc_correction_test.ngc", text), settings).steps;
}

/// The step of that line.
std::size_t on_line(const std::vector<NcStep>& steps, int line) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].where.line == line) return i;
  }
  ADD_FAILURE() << "no block on line " << line;
  return 0;
}

TEST(NcSteps, TellWhenWhereAndInWhichModes) {
  const std::vector<NcStep> s = steps_of("G21 G54\nG0 X60 Y80\n/ G1 Z-2 F60\nG20\nG91 X1\nG41 D1\nT1 M6\nG28\nM30\n");
  ASSERT_EQ(s.size(), 9u);
  EXPECT_EQ(*s[0].system, 540);
  EXPECT_EQ(s[1].kind, NcStepKind::kRapid);
  EXPECT_DOUBLE_EQ(s[1].end_s, 0.4);  // 100 mm at 0.25 m/s
  EXPECT_THAT(s[1].named, ElementsAre(true, true, false));
  EXPECT_THAT(s[1].known, ElementsAre(false, false, false));
  EXPECT_THAT(s[2].known, ElementsAre(true, true, false));
  EXPECT_TRUE(s[2].deletable);
  EXPECT_TRUE(s[2].plain);
  EXPECT_EQ(s[2].feed_word, "F60");
  EXPECT_DOUBLE_EQ(s[2].duration_s(), 2.0);
  EXPECT_EQ(s[3].kind, NcStepKind::kNone);
  EXPECT_FALSE(s[4].absolute);
  EXPECT_TRUE(s[4].before.absolute);
  EXPECT_DOUBLE_EQ(s[4].before.unit_m, 0.0254);
  EXPECT_DOUBLE_EQ(s[4].end_m[0], 0.0854);
  EXPECT_FALSE(s[4].motion_word);
  EXPECT_TRUE(s[5].compensated);
  EXPECT_TRUE(s[6].tool_change);
  EXPECT_DOUBLE_EQ(s[6].duration_s(), 8.0);
  EXPECT_EQ(s[7].kind, NcStepKind::kMachine);
  EXPECT_THAT(s[8].known, ElementsAre(false, false, false));
  EXPECT_TRUE(s[8].ends_program);
}

struct Allowed {
  const char* name;
  const char* text;
  int line;              ///< before which the offset changes
  const char* expected;  ///< x, y, z: R along a rapid, r a step after one, f a step in feed, - never
};

class NcPlaces : public ::testing::TestWithParam<Allowed> {};

TEST_P(NcPlaces, AreAllowed) {
  const std::vector<NcStep> steps = steps_of(std::string("G0 X0 Y0 Z5\n") + GetParam().text);
  std::string found;
  const std::array<NcEntry, 3> entries = nc_entries(steps)[on_line(steps, GetParam().line)];
  for (NcEntry e : entries) found += "Rrf-"[static_cast<int>(e)];
  EXPECT_EQ(found, GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(
    Each, NcPlaces,
    ::testing::Values(Allowed{"the_first_move_is_from_nowhere", "M30\n", 1, "RRR"},
                      Allowed{"a_rapid_brings_the_axes_it_names", "G0 X1 Z2\nM2\n", 2, "RrR"},
                      Allowed{"a_feed_move_brings_none", "G1 X1 F100\nX2\nM2\n", 2, "rrr"},
                      Allowed{"in_feed", "G1 X1 F100\nX2\nM2\n", 3, "fff"},
                      Allowed{"after_an_arc_with_a_word_to_come", "G2 X2 I1 F100\nG1 X3\nM2\n", 3, "fff"},
                      Allowed{"an_arc_that_goes_on", "G2 X2 I1 F100\nX4 I1\nM2\n", 3, "---"},
                      Allowed{"a_dwell_before_an_arc_that_goes_on", "G2 X2 I1 F100\nG4 P1\nX4 I1\nM2\n", 3, "---"},
                      Allowed{"a_dwell_before_an_arc_by_name", "G2 X2 I1 F100\nG4 P1\nG2 X4 I1\nM2\n", 3, "fff"},
                      Allowed{"before_a_canned_cycle", "G81 X1 Z-1 R1 F100\nX2\nG80\nM2\n", 2, "rrr"},
                      Allowed{"in_a_canned_cycle", "G81 X1 Z-1 R1 F100\nX2\nG80\nM2\n", 3, "---"},
                      Allowed{"a_rapid_that_ends_a_canned_cycle", "G81 X1 Z-1 R1 F100\nX2\nG0 Z9\nM2\n", 4, "---"},
                      Allowed{"after_a_canned_cycle", "G81 X1 Z-1 R1 F100\nG80\nG0 Z9\nM2\n", 4, "rrR"},
                      Allowed{"contour", "G41 D1 G1 X1 F100\nX2\nG40\nG0 X9\nM2\n", 3, "---"},
                      Allowed{"after_the_contour", "G41 D1 G1 X1 F100\nX2\nG40\nG0 X9\nM2\n", 5, "Rff"},
                      Allowed{"deletable", "/G0 X1\nM2\n", 2, "---"}, Allowed{"incremental", "G91\nG0 X1\nM2\n", 3, "rrr"},
                      Allowed{"inverse_time", "G93\nG1 X1 F1\nG1 X2 F1\nM2\n", 4, "---"},
                      Allowed{"rapid_after_inverse_time", "G93\nG1 X1 F1\nG0 X2\nM2\n", 4, "R--"},
                      Allowed{"after_the_machines_zero", "G28\nG0 X1\nM2\n", 3, "R--"},
                      Allowed{"after_a_tool_change", "M6\nG4 P1\nM2\n", 3, "---"},
                      Allowed{"after_a_tool_change_that_x_has_left", "M6\nG0 X1\nG4 P1\nM2\n", 4, "r--"},
                      Allowed{"without_the_length_of_the_tool", "G49\nG4 P1\nM2\n", 3, "---"},
                      Allowed{"with_another_length", "G43 H2\nG4 P1\nM2\n", 3, "---"},
                      Allowed{"put_with_another_length", "G43 H2 G0 Z9\nG4 P1\nM2\n", 3, "--r"},
                      Allowed{"another_work_offset", "G55\nG4 P1\nM2\n", 3, "---"},
                      Allowed{"after_a_deletable_block", "/G0 X1\nG4 P1\nM2\n", 3, "-rr"},
                      Allowed{"put_behind_a_deletable_block", "/G0 X1 Y1\nG0 Y2\nG4 P1\nM2\n", 4, "-rr"},
                      Allowed{"no_time", "M8\nM2\n", 2, "---"}),
    [](const auto& each) { return each.param.name; });

TEST(NcPlaces, SayWhyABlockCannotBeDivided) {
  const auto why = [](const std::string& text) {
    const std::vector<NcStep> steps = steps_of("G0 X0 Y0 Z5\n" + text + "\nM2\n");
    return why_not_divisible(steps[1]);
  };
  EXPECT_EQ(why("N10 G1 X5 Y2 F100"), "");
  EXPECT_EQ(why("X5 (comment)"), "");
  EXPECT_EQ(why("G2 X2 I1 F100"), "an arc");
  EXPECT_EQ(why("G4 P5"), "the axes are at rest");
  EXPECT_EQ(why("G28 X0"), "in machine coordinates");
  EXPECT_EQ(why("G81 X1 Z-1 R1 F100"), "a canned cycle");
  EXPECT_EQ(why("G91 X5"), "G91");
  EXPECT_EQ(why("G1 X5 F100 M8"), "it has more words than N, G0, G1, X, Y, Z, F");
  EXPECT_EQ(why("/X5"), "a block that '/' may leave out");
  EXPECT_EQ(why("G41 D1 G1 X5 F100"), "cutter compensation");
  const std::vector<NcStep> steps = steps_of("G0 X5\nM2\n");
  EXPECT_EQ(why_not_divisible(steps[0]), "its starting point is not stated");
}

const NcLanguage* const kLinuxCnc = nc_control("linuxcnc").languages.front();
const NcOffsetOptions kXZ{
    .language = kLinuxCnc, .absolute = true, .work_offset = 540, .base_m = {0.1, 0, -0.02}, .axes = {true, false, true}};
const NcOffsetOptions kAdded{
    .language = kLinuxCnc, .absolute = false, .work_offset = 540, .base_m = {0, 0, 0}, .axes = {true, false, true}};

/// The program without our remark and without the lines that look for offsets in force before it begins.
std::string lines_of(const CorrectedNcProgram& program) {
  std::string text = program.text;
  const auto drop = [&](const char* what) {
    const std::size_t at = text.find(what);
    if (at == std::string::npos) return false;
    const std::size_t begin = text.rfind('\n', at) + 1;
    text.erase(begin, text.find('\n', at) + 1 - begin);
    return true;
  };
  while (drop("driftwright") || drop("(abort")) continue;
  return text;
}

constexpr const char* kProgram =
    "%\r\n(part)\r\nN10 G21 G54\r\nN20 G0 X0 Z5\r\nN30 G1 Z-1 F100 ; down\r\nN40 X100\r\nN50 G2 X120 I10\r\n"
    "N60 G0 X0 Z5\r\nM30\r\n%\r\n";

TEST(CorrectedProgram, ForLinuxCncByValue) {
  const std::vector<NcStep> steps = steps_of(kProgram);
  const std::vector<NcOffsetChange> changes = {{on_line(steps, 6), 0.0, {{std::nullopt, std::nullopt, 12.5e-6}}},
                                               {on_line(steps, 6), 0.25, {{-1e-5, std::nullopt, std::nullopt}}},
                                               {on_line(steps, 8), 0.0, {{-2e-5, std::nullopt, 2e-5}}}};
  const CorrectedNcProgram c = corrected_nc_program(kProgram, steps, {0, 0, 0}, changes, kXZ);
  EXPECT_EQ(lines_of(c),
            "%\r\n(part)\r\nN10 G21 G54\r\nG10 L2 P1 X100 Z-20\r\nN20 G0 X0 Z5\r\nN30 G1 Z-1 F100 ; down\r\n"
            "G10 L2 P1 Z-19.9875\r\nG1 Z-1\r\nG1 X25\r\nG10 L2 P1 X99.99\r\nG1 X25\r\nN40 X100\r\nN50 G2 X120 I10\r\n"
            "G10 L2 P1 X99.98 Z-19.98\r\nN60 G0 X0 Z5\r\nG10 L2 P1 X100 Z-20\r\nM30\r\n%\r\n");
  EXPECT_THAT(c.lines, ElementsAre(8, 11, 15));
}

// Offsets and points are written in the unit in force: 12.7 um are 0.0005 inch. In G91 the line that commands the axis
// once more is absolute and the mode comes back.
TEST(CorrectedProgram, KeepsInchesAndIncrementalMode) {
  const std::string text = "G20 G59.1\nG0 X1 Y1 Z1\nG91\nX2\nG1 Y1 F10\nM2\n";
  const std::vector<NcStep> steps = steps_of(text);
  NcOffsetOptions options{
      .language = kLinuxCnc, .absolute = true, .work_offset = 591, .base_m = {}, .axes = {true, false, false}};
  const std::vector<NcOffsetChange> changes = {{4, 0.0, {{12.7e-6, std::nullopt, std::nullopt}}}};
  EXPECT_EQ(
      lines_of(corrected_nc_program(text, steps, {0, 0, 0}, changes, options)),
      "G20 G59.1\nG10 L2 P7 X0\nG0 X1 Y1 Z1\nG91\nX2\nG10 L2 P7 X0.0005\nG90 G0 X3\nG91\nG1 Y1 F10\nG10 L2 P7 X0\nM2\n");
  options.language = nc_control("siemens").languages.back();
  EXPECT_REFUSED(corrected_nc_program(text, steps, {0, 0, 0}, changes, options), "inches");
}

// X comes by the rapid, Z would not: the line that commands Z once more has X as well, so that no motion is seen on its own.
TEST(CorrectedProgram, CommandsAllAxesOfAChangeTogether) {
  const std::string text = "G21\nG0 X0 Z5\nG1 Z0 F100\nG0 X3\nM2\n";
  const std::vector<NcOffsetChange> changes = {{3, 0.0, {{1e-5, std::nullopt, 2e-5}}}};
  EXPECT_EQ(lines_of(corrected_nc_program(text, steps_of(text), {0, 0, 0}, changes, kXZ)),
            "G21\nG10 L2 P1 X100 Z-20\nG0 X0 Z5\nG1 Z0 F100\nG10 L2 P1 X100.01 Z-19.98\nG1 X0 Z0\nG0 X3\n"
            "G10 L2 P1 X100 Z-20\nM2\n");
}

// Units may come after the tool change: the first offset waits for the first motion, and so for them.
TEST(CorrectedProgram, SetsTheOffsetBeforeTheFirstMotion) {
  const std::string text = "T1 M6\nG20\nG0 X1\nM2\n";
  EXPECT_EQ(lines_of(corrected_nc_program(
                text, steps_of(text), {25.4e-6, 0, 0}, {},
                {.language = kLinuxCnc, .absolute = true, .work_offset = 540, .base_m = {}, .axes = {true, false, false}})),
            "T1 M6\nG20\nG10 L2 P1 X0.001\nG0 X1\nG10 L2 P1 X0\nM2\n");
}

// By default corrections are LinuxCNC's own shift above the work offsets: in the program's unit, of every fixture.
TEST(CorrectedProgram, AddsToTheWorkOffsetsByItsOwnShift) {
  const std::string text = "G21 G54\nG0 X0 Z5\nG1 Z-1 F100\nG55 G0 X1\nG20\nG0 X2\nM30\n";
  const std::vector<NcStep> steps = steps_of(text);
  const std::vector<NcOffsetChange> changes = {{2, 0.0, {{std::nullopt, std::nullopt, 12.5e-6}}},
                                               {5, 0.0, {{25.4e-6, std::nullopt, std::nullopt}}}};
  EXPECT_EQ(lines_of(corrected_nc_program(text, steps, {-5e-6, 0, 0}, changes, kAdded)),
            "G21 G54\nG52 X-0.005 Z0\nG0 X0 Z5\nG52 Z0.0125\nG0 Z5\nG1 Z-1 F100\nG55 G0 X1\nG20\nG52 X0.001\nG0 X2\nG52 X0 "
            "Z0\nM30\n");
}

TEST(CorrectedProgram, SaysInFrontWhatItDoesToOffsets) {
  const std::string text = "G21 G54\nG0 X0 Z5\nM30\n";
  EXPECT_THAT(corrected_nc_program(text, steps_of(text), {1e-5, 0, 0}, {}, kAdded).text,
              ::testing::AllOf(HasSubstr("(driftwright: corrections of drift by G52, added to the work offsets"),
                               HasSubstr("[#5211 NE 0] OR [#5213 NE 0]")));
  EXPECT_THAT(corrected_nc_program(text, steps_of(text), {1e-5, 0, 0}, {}, kXZ).text,
              HasSubstr("ABSOLUTE OFFSETS. G54 is overwritten, from X100 Z-20 mm on"));
}

TEST(CorrectedProgram, WithoutChangesIsTheProgramItself) {
  const std::string text = "G0 X1\r\nG1 Y2 F100\nM2";
  EXPECT_EQ(corrected_nc_program(text, steps_of(text), {0, 0, 0}, {}, kXZ).text, text);
}

// The last line has no end: the line before it gets the end of the others.
TEST(CorrectedProgram, EndsItsOwnLinesAsTheOthersEnd) {
  const std::string text = "G21\r\nG0 X1 Z0\r\nX2\r\nM2";
  const std::vector<NcOffsetChange> changes = {{2, 0.0, {{1e-5, std::nullopt, std::nullopt}}}};
  EXPECT_EQ(lines_of(corrected_nc_program(text, steps_of(text), {0, 0, 0}, changes, kXZ)),
            "G21\r\nG10 L2 P1 X100 Z-20\r\nG0 X1 Z0\r\nG10 L2 P1 X100.01\r\nX2\r\nG10 L2 P1 X100 Z-20\r\nM2");
}

TEST(CorrectedProgram, RefusesAnotherWorkOffsetByItsLine) {
  const std::string text = "G54\nG0 X1\nG55\nX2\nM2\n";
  const std::vector<NcStep> steps = steps_of(text);
  EXPECT_THAT(
      [&] {
        (void)corrected_nc_program(text, steps, {1e-5, 0, 0}, {}, kXZ);
      },
      ThrowsMessage<InputError>(::testing::AllOf(HasSubstr(":3:"), HasSubstr("G55"), HasSubstr("G54"))));
}

struct Refused {
  const char* name;
  const char* text;
  const char* where;
  const char* message;
  int work_offset = 540;
};

class RefusedPrograms : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedPrograms, AreNamedByTheirLine) {
  const std::vector<NcStep> steps = steps_of(GetParam().text);
  NcOffsetOptions options = kXZ;
  options.work_offset = GetParam().work_offset;
  EXPECT_THAT(
      [&] {
        (void)corrected_nc_program(GetParam().text, steps, {1e-5, 0, 0}, {}, options);
      },
      ThrowsMessage<InputError>(::testing::AllOf(HasSubstr(GetParam().where), HasSubstr(GetParam().message))));
}

INSTANTIATE_TEST_SUITE_P(
    Each, RefusedPrograms,
    ::testing::Values(
        Refused{"no_unit", "S1000\nG0 X1\nM2\n", ":2:", "write G21 or G20"},
        Refused{"unit_with_the_first_motion", "S1000\nG20 G0 X1\nM2\n", ":2:", "write G21 or G20"},
        Refused{"unit_that_may_be_left_out", "/G20\nG0 X1\nM2\n", ":2:", "write G21 or G20"},
        Refused{"unit_behind_a_contour", "G41 D1\nG21\nG0 X1\nG40\nM2\n", ":1:", "write G21 or G20"},
        Refused{"contour_at_the_end", "G21\nG41 D1\nG1 X9 F10\nM2\n", ":4:", "end it before"},
        Refused{"contour_that_ends_with_the_program", "G21\nG41 D1\nG1 X9 F10\nG40 M2\n", ":4:", "end it before"},
        Refused{"work_offset_never_named", "G21\nG0 X1\nM2\n", ":2:", "G55, which `work_offset` names", 550},
        Refused{"work_offset_named_late", "G21\nG0 X1\nG55\nM2\n", ":2:", "G55, which `work_offset` names", 550},
        Refused{"work_offset_that_may_be_left_out", "G21\n/G55\nG0 X1\nM2\n", ":3:", "G55, which", 550},
        Refused{"last_block_cuts", "G21\nG0 X1\nG1 X9 F10 M30\n", ":3:", "the last block cuts"},
        Refused{"last_block_cuts_an_arc", "G21\nG0 X1\nG2 X9 I4 F10 M30\n", ":3:", "the last block cuts"}),
    [](const auto& each) { return each.param.name; });

TEST(CorrectedProgram, NotesALastBlockThatMoves) {
  const std::string text = "G21\nG0 X1\nG0 X9 M2\n";
  const CorrectedNcProgram c = corrected_nc_program(text, steps_of(text), {1e-5, 0, 0}, {}, kXZ);
  EXPECT_THAT(c.notes, ElementsAre(HasSubstr("line 3: the last block moves")));
  EXPECT_EQ(lines_of(c), "G21\nG10 L2 P1 X100.01 Z-20\nG0 X1\nG10 L2 P1 X100 Z-20\nG0 X9 M2\n");
}

// G10 is an error with G41 or G42 on.
TEST(CorrectedProgram, SetsTheOffsetBeforeTheContour) {
  const std::string text = "G21 G54\nM3\nG41 D1\nG0 X1\nG40\nM2\n";
  EXPECT_EQ(lines_of(corrected_nc_program(text, steps_of(text), {1e-5, 0, 0}, {}, kXZ)),
            "G21 G54\nM3\nG10 L2 P1 X100.01 Z-20\nG41 D1\nG0 X1\nG40\nG10 L2 P1 X100 Z-20\nM2\n");
}

TEST(CorrectedProgram, WantsAnAllowedPlace) {
  const std::string text = "G21\nG0 X1 Z1\nG81 X1 Z-1 R1 F100\nX2\nG80\nM2\n";
  const std::vector<NcOffsetChange> changes = {{3, 0.0, {{1e-5, std::nullopt, std::nullopt}}}};
  EXPECT_THROW((void)corrected_nc_program(text, steps_of(text), {0, 0, 0}, changes, kXZ), std::logic_error);
}

}  // namespace
}  // namespace driftwright::nc_correction_test
