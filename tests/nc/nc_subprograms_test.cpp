// Parameters, expressions, subprograms, loops and shifts of the origin of RS-274 programs: against LinuxCNC's own
// interpreter, motion for motion; and corrections of such programs, run by it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "nc/correction.hpp"
#include "nc/places.hpp"
#include "nc/program.hpp"
#include "tests/nc/rs274.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::nc_subprograms_test {
namespace {

using ::testing::AllOf, ::testing::ElementsAre, ::testing::HasSubstr;

NcSettings settings() {
  return {.rapid_m_s = 0.25,
          .tool_change_s = 8.0,
          .dwell_P_s = 1.0,
          .machine_zero_m = std::array<double, 3>{0.0, 0.0, 0.5},
          .ignored = {}};
}

NcProgram read(const std::string& path) {
  return read_nc_program(path, settings());
}

bool moves(const NcStep& step) {
  return step.kind == NcStepKind::kRapid || step.kind == NcStepKind::kLine || step.kind == NcStepKind::kArc;
}

struct Program {
  const char* name;
  const char* text;
};

class NcSubprograms : public ::testing::TestWithParam<Program> {};

// Every end of every motion, in the coordinates of the program, to the four decimals that the interpreter prints.
TEST_P(NcSubprograms, MoveAsLinuxCncDoes) {
  const std::string path = write_file("nc_subprograms.ngc", GetParam().text);
  const NcProgram program = read(path);
  if (!has_rs274()) GTEST_SKIP() << kNoRs274;
  const Rs274Run judge = run_rs274(path);
  ASSERT_TRUE(judge.accepted) << judge.said;
  std::vector<const NcStep*> ours;
  for (const NcStep& step : program.steps) {
    if (moves(step)) ours.push_back(&step);
  }
  ASSERT_GT(judge.motions.size(), 3U);
  ASSERT_EQ(ours.size(), judge.motions.size()) << judge.said;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const char kind = ours[i]->kind == NcStepKind::kRapid ? 'R' : ours[i]->kind == NcStepKind::kLine ? 'L' : 'A';
    EXPECT_EQ(kind, judge.motions[i].kind) << i << ", line " << ours[i]->where.line;
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(1e3 * ours[i]->end_m[axis], judge.motions[i].program_mm[axis], judge.motions[i].printed_mm)
          << i << ", line " << ours[i]->where.line << ", axis " << axis;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, NcSubprograms,
    ::testing::Values(
        Program{"expressions",
                "G21 G90\nF600\n#1=3.5 #<width>=[#1*2]\nG0 X#1 Y[#<width>+1]\nG1 X[10 MOD 4] Y[2**3] Z-#1\nG1 X[SIN[30]*10] "
                "Y[ATAN[1]/[1]] Z[SQRT[2]]\n"
                "G1 X[FIX[-1.5]] Y[FUP[1.2]] Z[ROUND[2.5]]\nG1 X[ABS[-4]] Y[[3 GT 2]+[2 EQ 2.00001]+[1 NE 1]] Z[[1 AND 0] "
                "OR 1]\n"
                "#1=7 G1 X#1\nG1 X#1 Y[1 XOR 1] Z[ACOS[0.5]]\nG1 X[EXISTS[#<width>]+EXISTS[#<height>]] Y[LN[EXP[2]]] "
                "Z[-[3-5]]\nM2\n"},
        Program{"precedence",
                "G21 G90 F600\nG1 X[2+3*4] Y[2*3**2] Z[10-4-3]\nX[100/5/2] Y[1+2 GT 2] Z[0 OR 1 AND 0]\nX[5 MOD 3 * 2] "
                "Y[-2**2] Z[+1--1]\nX#[1+1] Y1\nM2\n"},
        Program{"subroutines",
                "o100 sub\nG1 X[#1] Y[#2]\no100 if [#3 GT 0]\nG1 Z-#3\nG1 Z0\no100 endif\no100 endsub [#1+#2]\nG21 "
                "G90\nF600\nG0 X0 Y0 Z5\no100 call [10] [20] [3]\n"
                "G1 X#<_value>\no<hole> sub\n#<_depth>=5\no101 repeat [3]\nG91 G1 X5\nG90\no101 endrepeat\no<hole> "
                "endsub\no<hole> call\nG1 Z-#<_depth>\nM2\n"},
        Program{"locals",
                "o1 sub\n#1=99\n#31=[#31+1]\n#<a>=5\nG1 X#<a>\no1 endsub\nG21 G90 F600\n#1=1\n#31=10\n#<a>=2\no1 call "
                "[7]\nG1 X#1 Y#31 Z#<a>\no1 call\nG1 X#1 Y#31\nM2\n"},
        Program{"loops",
                "G21 G90 F600\n#1=0\no1 while [#1 LT 3]\nG1 X#1\n#2=0\no2 do\nG1 Y[#1*10+#2]\n#2=[#2+1]\no2 while [#2 LT "
                "2]\no3 if [#1 EQ 1]\n#1=[#1+1]\no1 continue\no3 endif\n"
                "#1=[#1+1]\no1 endwhile\no4 while [1]\n#1=[#1+1]\nG1 Z-#1\no5 if [#1 GE 6]\no4 break\no5 endif\no4 "
                "endwhile\no6 do\nG1 Y-1\no6 break\no6 while [1]\nG1 Y-2\nM2\n"},
        Program{"branches",
                "G21 G90 F600\n#5=1\no9 repeat [4]\no1 if [#5 EQ 1]\nG1 X1\no1 elseif [#5 EQ 2]\nG1 X2\no1 elseif [#5 EQ "
                "3]\nG1 X3\no1 else\nG1 X4\no1 endif\n#5=[#5+1]\no9 endrepeat\nM2\n"},
        Program{"return_early",
                "o1 sub\nG1 X#1\no2 if [#1 LT 3]\no1 return\no2 endif\nG1 Y#1\no1 endsub\nG21 G90 F600\no1 call [2]\no1 "
                "call [3]\no1 call [4]\nM2\n"},
        Program{
            "recursion",
            "o1 sub\nG1 X#1\no2 if [#1 GT 1]\no1 call [#1-1]\no2 endif\nG1 Y#1\no1 endsub\nG21 G90 F600\no1 call [4]\nM2\n"},
        Program{"fanuc_subprograms",
                "G21 G90 F600\nG0 X0 Y0\nM98 P100 L3\nG1 Y5\nM98 P200\nM2\nO100\nG91 G1 X10\nG90\nM99\nO200\nG1 Z-1\nM98 "
                "P100\nM99\n"},
        Program{"arcs_in_a_loop",
                "G21 G90 G17 F600\nG0 X10 Y0\n#1=0\no1 while [#1 LT 4]\n#1=[#1+1]\nG3 X[10*COS[90*#1]] Y[10*SIN[90*#1]] "
                "I[-10*COS[90*[#1-1]]] J[-10*SIN[90*[#1-1]]]\no1 endwhile\nM2\n"},
        Program{"shifts_of_the_origin",
                "G21 G90 F600\nG0 X10 Y10 Z5\nG92 X0 Y0\nG1 X5\nG1 Y5\nG92.1\nG1 X20\nG52 X3 Z1\nG1 X20 Z5\nG52 X0 Z0\nG1 "
                "X20 Y1 Z1\nM2\n"},
        Program{"offsets_of_its_own",
                "G21 G90 G54 F600\nG0 X10 Y10 Z5\nG10 L20 P1 X0 Z1\nG1 X5 Y5\nG1 Z2\nG10 L20 P0 Y100\nG1 X6\nM2\n"},
        Program{"where_it_stands",
                "G21 G90 F600\nG0 X10 Y20 Z5\nG1 X[#5420+1] Y[#<_y>-1]\nG20\nG1 X[#5420+1]\nG21\nG1 X[#5420*2]\nM2\n"},
        Program{"several_fixtures",
                "G21 G90 G54 F600\nG10 L2 P1 X100 Y0 Z0\nG10 L2 P2 X300 Y50 Z0\nG0 X0 Y0 Z5\nG1 X10\nG55 G0 X0 Y0\nG1 X10 "
                "Z4\nG54\nG1 X5\nG1 Y1\nM2\n"}),
    [](const auto& each) { return std::string(each.param.name); });

TEST(NcSubroutineFiles, StandBesideTheProgram) {
  (void)write_file("drill_row.ngc",
                   "o<drill_row> sub\no1 repeat [#1]\nG91 G1 X5\nG90\no1 endrepeat\no<drill_row> endsub\nM2\n");
  const std::string path = write_file("calls_a_file.ngc", "G21 G90 F600\nG0 X0\no<Drill_Row> call [3]\nG1 Y5\nM2\n");
  const NcProgram program = read(path);
  EXPECT_NEAR(program.duration_s(), 1.5 + 0.5, 1e-12);
  for (const NcStep& step : program.steps) EXPECT_EQ(step.no_place, step.where.file != path);
  if (!has_rs274()) GTEST_SKIP() << kNoRs274;
  EXPECT_EQ(run_rs274(path).motions.size(), 5U);
}

TEST(NcSubprograms, SayWhatIsKnownAtTheMachineAloneAndPlanTheRest) {
  const NcProgram program = read(write_file("probing.ngc",
                                            "G21 G90 G54\nG0 X0 Y0 Z10\nG38.2 Z-5 F60\n#<top>=#5063\nG0 Z10\nG1 Z#<top> "
                                            "F120\no1 if [#5070 EQ 0]\nG4 P1000\no1 endif\n"
                                            "G10 L20 P1 Z0\nG1 Z2\nG1 X[#5221+1]\nM2\n"));
  EXPECT_THAT(program.notes,
              ElementsAre(AllOf(HasSubstr("line 3: G38.2"), HasSubstr("known only at the machine")),
                          AllOf(HasSubstr("line 7: IF"), HasSubstr("planned as if it were false")),
                          AllOf(HasSubstr("line 1"), HasSubstr("#5221: its value is known only at the machine"))));
  EXPECT_NEAR(program.steps[2].duration_s(), 15.0, 1e-9);  // all of its way
  EXPECT_FALSE(program.steps[3].known[2]);                 // the touch point is unknown
  EXPECT_TRUE(program.steps[4].known[2]);                  // after G0 Z10
  EXPECT_FALSE(program.steps[5].known[2]);                 // at what was probed
  EXPECT_TRUE(program.steps[6].known[2]);                  // G10 L20: it is at 0
  EXPECT_DOUBLE_EQ(program.steps[6].start_m[2], 0.0);
}

TEST(NcSubprograms, CountPositionsFromTheParameterFile) {
  NcSettings with = settings();
  with.parameters = {{5221, 100.0}, {5222, 0.0}, {5223, 0.0}, {5241, 350.0}, {5242, 0.0}, {5243, 0.0}};
  const std::string text = "G21 G54\nG0 X0\nG55\nG0 X0\nM2\n";
  EXPECT_DOUBLE_EQ(read_nc_program(write_file("fixtures.ngc", text), with).duration_s(), 1.0);  // 250 mm at 250 mm/s
  const NcProgram without = read_nc_program(write_file("fixtures.ngc", text), settings());
  EXPECT_DOUBLE_EQ(without.duration_s(), 0.0);
  EXPECT_THAT(without.notes, ElementsAre(HasSubstr("line 3: G55: this is another coordinate system")));
}

struct Mistaken {
  const char* name;
  const char* text;
  std::vector<const char*> message;
};

class NcSubprogramErrors : public ::testing::TestWithParam<Mistaken> {};

TEST_P(NcSubprogramErrors, NameTheLine) {
  try {
    (void)read(write_file("nc_subprograms.ngc", GetParam().text));
    FAIL() << "was accepted";
  } catch (const InputError& e) {
    for (const char* part : GetParam().message) EXPECT_THAT(e.what(), HasSubstr(part));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, NcSubprogramErrors,
    ::testing::Values(
        Mistaken{"endless", "o1 while [1]\no1 endwhile\nM2\n", {"has run 500003 blocks", "a loop without end"}},
        Mistaken{"endless_with_moves", "G21\no1 do\nG4 P1\no1 while [1]\nM2\n", {"has run 500005 blocks"}},
        Mistaken{"recursion", "o1 sub\no1 call\no1 endsub\no1 call\nM2\n", {":2:1:", "nested more than 10 deep"}},
        Mistaken{"no_subroutine", "o<away> call\nM2\n", {":1:1:", "no subroutine O<AWAY>", "away.ngc"}},
        Mistaken{"no_subprogram", "M98 P7\nM2\n", {"no subprogram O7"}},
        Mistaken{"no_end_of_loop", "o1 while [0]\nM2\n", {":1:1: O1 WHILE has nothing that ends it"}},
        Mistaken{"break_of_a_repetition",
                 "o4 repeat [2]\no4 break\no4 endrepeat\nM2\n",
                 {":2:1: O4 BREAK has nothing that ends it"}},
        Mistaken{"unset_name", "G1 X#<a> F100\nM2\n", {":1:10: #<A> has no value yet"}},
        Mistaken{"no_bracket", "G1 X[1+2 F100\nM2\n", {":1:10: ']' is expected"}},
        Mistaken{"division", "#1=[1/0]\nM2\n", {":1:", "the expression divides by zero"}},
        Mistaken{"root", "#1=SQRT[-1]\nM2\n", {"the number under the root is negative"}},
        Mistaken{"function", "#1=FOO[1]\nM2\n", {"'FOO' is no function"}},
        Mistaken{"assignment", "#1 5\nM2\n", {"'=' is expected"}}),
    [](const auto& each) { return std::string(each.param.name); });

// --- corrections, run by LinuxCNC
// -------------------------------------------------------------------------------------------------

/// The operator's own offsets, in inches: G54 and G55 are nowhere near zero.
const std::map<int, double> kOperator = {{5221, 10.0}, {5222, 20.0}, {5223, -3.0}, {5241, 15.0}, {5242, 22.0}, {5243, -3.1}};

std::map<int, double> work_offsets(const Rs274Run& run) {
  std::map<int, double> offsets;
  for (const auto& [number, value] : run.parameters) {
    if (number >= 5221 && number <= 5390) offsets[number] = value;
  }
  return offsets;
}

/// Runs a program without and with corrections: each motion must end where it did, and beside it by what is in force.
/// @param changes  line, run of that line, and the correction [um] of z from there on
void expect_shifted_by_the_corrections(const std::string& name, const std::string& text, double initial_um,
                                       const std::vector<std::tuple<int, int, double>>& changes) {
  const std::string path = write_file(name + ".ngc", text);
  const NcProgram program = read(path);
  std::vector<NcOffsetChange> offsets;
  std::vector<double> in_force_um(program.steps.size(), initial_um);
  for (const auto& [line, run, um] : changes) {
    for (std::size_t i = 0; i < program.steps.size(); ++i) {
      if (program.steps[i].where.line != line || program.steps[i].nth_run != run) continue;
      ASSERT_NE(nc_entries(program.steps, i)[2], NcEntry::kNever) << "line " << line;
      offsets.push_back({i, 0.0, {{std::nullopt, std::nullopt, 1e-6 * um}}});
      for (std::size_t k = i; k < in_force_um.size(); ++k) in_force_um[k] = um;
    }
  }
  ASSERT_EQ(offsets.size(), changes.size());
  const CorrectedNcProgram corrected = corrected_nc_program(text, program.steps, {0, 0, 1e-6 * initial_um}, offsets,
                                                            {.language = program.language, .axes = {false, false, true}});
  if (!has_rs274()) GTEST_SKIP() << kNoRs274;
  const Rs274Run without = run_rs274(path, kOperator),
                 with = run_rs274(write_file(name + "_corrected.ngc", corrected.text), kOperator);
  ASSERT_TRUE(without.accepted) << without.said;
  ASSERT_TRUE(with.accepted) << corrected.text << with.said;
  EXPECT_EQ(work_offsets(with), work_offsets(without)) << "the operator's offsets";
  for (const int n : {5211, 5212, 5213}) EXPECT_NEAR(with.parameters.at(n), without.parameters.at(n), 1e-12) << n;
  std::vector<Rs274Motion> motions;  // without the lines that command an axis once more
  for (const Rs274Motion& motion : with.motions) {
    bool again = !motions.empty() && motion.kind != 'A';
    for (int axis = 0; axis < 3 && again; ++axis)
      again = std::abs(motion.program_mm[axis] - motions.back().program_mm[axis]) <
              motion.printed_mm + motions.back().printed_mm;
    if (again) motions.back().machine_mm = motion.machine_mm;
    if (!again) motions.push_back(motion);
  }
  ASSERT_EQ(motions.size(), without.motions.size()) << corrected.text << with.said;
  std::size_t k = 0;
  for (std::size_t i = 0; i < program.steps.size(); ++i) {
    if (!moves(program.steps[i])) continue;
    // The last look at a place comes after the line of the next change that commands it again.
    std::size_t next = i + 1;
    while (next + 1 < program.steps.size() && !moves(program.steps[next])) ++next;
    const double next_um = next < in_force_um.size() ? in_force_um[next] : in_force_um[i];
    const double z_mm = motions[k].machine_mm[2] - without.motions[k].machine_mm[2];
    EXPECT_THAT(z_mm, ::testing::AnyOf(::testing::DoubleNear(1e-3 * in_force_um[i], 4.0 * motions[k].printed_mm),
                                       ::testing::DoubleNear(1e-3 * next_um, 4.0 * motions[k].printed_mm)))
        << "line " << program.steps[i].where.line << "\n"
        << corrected.text;
    for (const int axis : {0, 1})
      EXPECT_NEAR(motions[k].machine_mm[axis], without.motions[k].machine_mm[axis], 4.0 * motions[k].printed_mm);
    ++k;
  }
  EXPECT_EQ(static_cast<int>(corrected.lines.size()), static_cast<int>(changes.size()));
  std::vector<std::string> lines;
  std::istringstream stream(corrected.text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  for (const int line : corrected.lines)
    EXPECT_THAT(lines.at(static_cast<std::size_t>(line) - 1),
                AnyOf(::testing::StartsWith("G52 Z"), ::testing::StartsWith("G92 Z")));
}

TEST(CorrectionsOnLinuxCnc, LeaveTheOperatorsOffsetsAndMoveThePathByThemselves) {
  expect_shifted_by_the_corrections("one_fixture",
                                    "G21 G90 G54\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX50\nY50\nG2 X60 Y60 I10\nG1 X0\nG0 Z5\nM2\n",
                                    -500.0, {{4, 1, 1500.0}, {5, 1, -750.0}, {8, 1, 2500.0}});
}

TEST(CorrectionsOnLinuxCnc, HoldInSeveralFixtures) {
  expect_shifted_by_the_corrections("two_fixtures",
                                    "G21 G90 G54\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX50\nG0 Z5\nG55 G0 X0 Y0 Z5\nG1 "
                                    "Z-1\nX50\nG54\nG0 X0 Y0 Z5\nG1 Z-2\nG0 Z5\nM2\n",
                                    0.0, {{4, 1, 1500.0}, {8, 1, -750.0}, {11, 1, 500.0}});
}

TEST(CorrectionsOnLinuxCnc, StandInLoopsAndSubprogramsAtTheRunThatIsMeant) {
  expect_shifted_by_the_corrections(
      "loops",
      "o1 sub\nG1 X50 F100\nG1 X0\no1 endsub\nG21 G90 G54\nG0 X0 Y0 Z5\n#1=0\no2 while [#1 LT 4]\n#1=[#1+1]\nG1 Z-#1 "
      "F100\no1 call\nG0 Z5\no2 endwhile\nM98 P50 L2\nM2\nO50\nG1 Y5\nG1 Y0\nM99\n",
      250.0, {{2, 2, 1000.0}, {3, 3, -500.0}, {12, 3, 750.0}, {3, 4, 1250.0}, {18, 2, -1000.0}});
}

// A G92 of the program's own: the correction is added to it, and the G92 that remains is the same as without it.
TEST(CorrectionsOnLinuxCnc, AreAddedToTheShiftsOfTheProgram) {
  expect_shifted_by_the_corrections("own_g92",
                                    "G21 G90 G54\nG0 X0 Y0 Z5\nG92 X0 Y0 Z0\nG1 Z-1 F100\nX50\nG92.1\nG1 Z3\nX0\nG52 X5 "
                                    "Z1\nG1 Z0\nX50\nG52 X0 Z0\nG0 Z10\nG92 Z0\nG0 Z9\nM2\n",
                                    300.0, {{5, 1, 1500.0}, {8, 1, -750.0}, {11, 1, 500.0}, {15, 1, 1000.0}});
}

TEST(CorrectionsOnLinuxCnc, KeepTheUnitOfTheProgram) {
  expect_shifted_by_the_corrections("inches", "G20 G90 G54\nG0 X0 Y0 Z1\nG1 Z-1 F10\nX2\nG21\nX100 F100\nG0 Z25\nM2\n",
                                    254.0, {{4, 1, 1270.0}, {6, 1, -508.0}});
}

// The correction of an aborted run, or a G92 of the operator's: the program stops before it moves, and says what to do.
TEST(CorrectionsOnLinuxCnc, RefuseToRunAboveAnotherShift) {
  if (!has_rs274()) GTEST_SKIP() << kNoRs274;
  const std::string text = "G21 G90 G54\nG0 X0 Y0 Z5\nG1 Z-1 F100\nM2\n";
  const NcProgram program = read(write_file("guarded.ngc", text));
  const CorrectedNcProgram corrected = corrected_nc_program(text, program.steps, {0, 0, 1e-5}, {},
                                                            {.language = program.language, .axes = {true, false, true}});
  const std::string path = write_file("guarded_corrected.ngc", corrected.text);
  EXPECT_TRUE(run_rs274(path, kOperator).accepted);
  for (const auto& [parameters, word] : std::vector<std::pair<std::map<int, double>, const char*>>{
           {{{5210, 1.0}, {5213, 0.0005}}, "G92.1"}, {{{5230, 15.0}}, "rotated"}}) {
    const Rs274Run run = run_rs274(path, parameters);
    EXPECT_FALSE(run.accepted);
    EXPECT_TRUE(run.motions.empty());
    EXPECT_THAT(run.said, HasSubstr(word));
  }
}

TEST(CorrectionsOnLinuxCnc, RefuseAG92OfAnAxisThatHasNotTakenThem) {
  const std::string text = "G21 G90 G54\nG0 X0 Y0\nG92 Z0\nG0 Z5\nM2\n";
  const NcProgram program = read(write_file("late.ngc", text));
  EXPECT_REFUSED(corrected_nc_program(text, program.steps, {0, 0, 1e-5}, {},
                                      {.language = program.language, .axes = {false, false, true}}),
                 ":3:", "G92 of Z");
}

}  // namespace
}  // namespace driftwright::nc_subprograms_test
