// `driftwright schedule` as a user runs it; its LinuxCNC programs read by LinuxCNC's own interpreter, where that is
// installed. One file: all its cases correct programs for one machine.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/record.hpp"
#include "tests/app/scheduled.hpp"
#include "tests/shared/edited_text.hpp"
#include "tests/shared/one_hal.hpp"

namespace driftwright::schedule_verb_test {
namespace {

using fixtures::lines_of;
using ::testing::AllOf, ::testing::ContainsRegex, ::testing::HasSubstr;

/// Three hours of passes: lines, arcs, incremental moves, a canned cycle.
std::string passes() {
  std::string text = "%\nG21 G90 G17 G54\nS2000 M3\nG0 X0 Y0 Z5\n";
  for (int i = 0; i < 12; ++i) {
    text += "G1 Z-1 F50\nX300 F50 (pass)\nG3 X310 Y10 J10\nG1 Y20\nX0 F60\nG0 Z5\nG0 X0 Y0\n";
    if (i % 3 == 1) text += "G81 X5 Y5 Z-10 R2 F20\nX40\nG80\nG0 X0 Y0 Z5\n";
    if (i % 4 == 2) text += "G91\nG1 X10 F50\nX-10\nG90\n";
  }
  return text + "M30\n%\n";
}

/// Where a motion of rs274 ends: x, y, z of a line, u, v, w of an arc in the plane XY.
std::vector<double> end_of(const std::string& motion) {
  std::vector<double> n(6);
  const auto open = motion.find('(');
  if (std::sscanf(motion.c_str() + open, "(%lf, %lf, %lf, %lf, %lf, %lf", &n[0], &n[1], &n[2], &n[3], &n[4], &n[5]) != 6)
    return {};
  return motion.starts_with("ARC_FEED") ? std::vector{n[0], n[1], n[5]} : std::vector{n[0], n[1], n[2]};
}

/// A program as rs274 runs it: motions with their coordinates in the work offset, and the offsets.
struct Path {
  std::vector<std::string> motions;  ///< such as "STRAIGHT_FEED(1.0000, ..."
  std::vector<std::array<double, 3>> offsets_mm;
  bool accepted = false;  ///< exit code 0, and it came to the end
  std::string said;
};

bool has_rs274() {
  return std::system("command -v rs274 >/dev/null 2>&1") == 0;
}

constexpr const char* kNoRs274 = "no rs274 here; Debian's linuxcnc-uspace has it";

Path rs274(const std::filesystem::path& program) {
  // In a folder of the test's own: the interpreter keeps its parameters in a file where it runs.
  FILE* pipe = popen(
      ("cd " + program.parent_path().string() + " && " + kOneHal + "rs274 -g " + program.string() + " 2>&1").c_str(), "r");
  Path path;
  char buffer[4096];
  while (std::fgets(buffer, sizeof buffer, pipe)) path.said += buffer;
  path.accepted = pclose(pipe) == 0 && path.said.find("PROGRAM_END") != std::string::npos;
  bool behind_an_offset = false;
  for (const std::string& line : lines_of(path.said)) {
    const auto find = [&](const char* call) { return line.find(call) != std::string::npos; };
    if (find("SET_G92_OFFSET(")) {
      std::array<double, 3> offset{};
      const std::string call = line.substr(line.find("SET_G92"));
      if (std::sscanf(call.c_str(), "SET_G92_OFFSET(%lf, %lf, %lf", &offset[0], &offset[1], &offset[2]) == 3)
        path.offsets_mm.push_back(offset);
      behind_an_offset = true;
    } else if (find("STRAIGHT_") || find("ARC_FEED(")) {
      path.motions.push_back(line.substr(line.find(find("STRAIGHT_") ? "STRAIGHT_" : "ARC_FEED(")));
      // After an offset the axes may be commanded again to where they are: no motion of the program.
      const std::vector<double> here = end_of(path.motions.back());
      if (behind_an_offset && path.motions.size() > 1 && !find("ARC_FEED(") &&
          here == end_of(path.motions[path.motions.size() - 2]))
        path.motions.pop_back();
      behind_an_offset = false;
    }
  }
  return path;
}

TEST(ScheduleVerb, WritesTheProgramAndItsSchedule) {
  const Scheduled s = run_schedule("verb", passes(), "--policy paper");
  ASSERT_EQ(s.outcome.exit_code, 0) << s.outcome.output;
  EXPECT_THAT(s.outcome.output, AllOf(HasSubstr("part.ngc"), ContainsRegex("z +nose_z +10.0 "),
                                      ContainsRegex("x +nose_x +4.0 "), HasSubstr("policy paper, written for LinuxCNC")));
  EXPECT_THAT(read_text(s.folder / "schedule.txt"), AllOf(HasSubstr("# axis z, nose_z"), HasSubstr("}-{0,10,10")));
  EXPECT_THAT(read_text(s.folder / "report.html"), HasSubstr("what is left"));
  EXPECT_GT(read_record_csv((s.folder / "record.csv").string()).at("nose_z").values.back(), 30.0);
  // Lines of the table are those of the offsets in the corrected program.
  const std::vector<std::string> corrected = lines_of(read_text(s.folder / "part.ngc"));
  const std::vector<std::string> table = lines_of(read_text(s.folder / "schedule.csv"));
  ASSERT_GT(table.size(), 5u);
  EXPECT_EQ(
      table[1],
      "time_s,line,corrected_line,x_increment_um,x_correction_um,x_offset_mm,z_increment_um,z_correction_um,z_offset_mm");
  for (std::size_t i = 3; i < table.size(); ++i) {
    int line = 0, corrected_line = 0;
    double time_s = 0.0;
    ASSERT_EQ(std::sscanf(table[i].c_str(), "%lf,%d,%d", &time_s, &line, &corrected_line), 3) << table[i];
    EXPECT_THAT(corrected.at(static_cast<std::size_t>(corrected_line) - 1), HasSubstr("G52 "));
  }
}

constexpr const char* kAbsolute = "  offset: absolute\n  base_offset: [100 mm, 50 mm, -20 mm]\n";

// nose_z rises: Z goes back from its -20 mm in steps of 10 um. nose_x falls along -x of the program: X goes back as well.
TEST(ScheduleVerb, MovesTheOffsetAgainstTheDriftFromItsBase) {
  const Scheduled s = run_schedule("signs", passes(), "--policy paper", std::string(kScheduledHead) + kAbsolute);
  const std::string text = read_text(s.folder / "part.ngc");
  EXPECT_THAT(text, HasSubstr("G10 L2 P1 X100 Z-20\n"));
  EXPECT_THAT(text, HasSubstr("Z-20.01\n"));
  EXPECT_THAT(text, HasSubstr("X99.996"));
}

// What the operator has set is lost: said on the terminal, on the page and in the program itself. By default nothing is
// overwritten.
TEST(ScheduleVerb, SaysLoudlyThatOffsetsAreOverwritten) {
  const Scheduled absolute = run_schedule("absolute", passes(), "", std::string(kScheduledHead) + kAbsolute),
                  added = run_schedule("added", passes());
  ASSERT_EQ(absolute.outcome.exit_code, 0) << absolute.outcome.output;
  EXPECT_THAT(absolute.outcome.output, HasSubstr("what the operator has set is overwritten"));
  EXPECT_THAT(read_text(absolute.folder / "report.html"), HasSubstr("what the operator has set is overwritten"));
  EXPECT_THAT(read_text(absolute.folder / "part.ngc"), HasSubstr("ABSOLUTE OFFSETS. G54 is overwritten"));
  EXPECT_THAT(added.outcome.output, Not(HasSubstr("overwritten")));
  EXPECT_THAT(read_text(added.folder / "part.ngc"),
              AllOf(HasSubstr("added to the work offsets"), HasSubstr("\nG52 X0 Z0\n"), Not(HasSubstr("G10"))));
}

// The machine is 5 K above its reference, 20 um: corrected from the start on, unless the workpiece was set up warm.
TEST(ScheduleVerb, CountsTheDriftFromTheReferenceOrFromTheStart) {
  std::string scenario = kScheduledHead;
  scenario.replace(scenario.find("reference_temperature: 20 degC"), 30, "reference_temperature: 15 degC\nstart: ambient");
  const std::string reference = read_text(run_schedule("from_reference", passes(), "", scenario).folder / "schedule.csv");
  const std::string start =
      read_text(run_schedule("from_start", passes(), "", scenario + "  drift_from: start\n").folder / "schedule.csv");
  EXPECT_THAT(lines_of(reference).at(2), Not(HasSubstr(",0.000,0.000,0.000000")));
  EXPECT_THAT(lines_of(start).at(2), HasSubstr(",0.000,0.000,0.000000"));
}

/// The passes of passes() as other controls write them.
std::string siemens_passes() {
  std::string text = "N10 G71 G90 G17 G54 ; mm\nN20 MSG(\"passes\")\nS1=2000 M1=3\nG0 X0 Y0 Z5\n";
  for (int i = 0; i < 12; ++i) text += "G1 Z-1 F50\nX300 F50 ; pass\nG3 X310 Y10 I0 J10\nG1 Y20\nX0 F60\nG0 Z5\nG0 X0 Y0\n";
  return text + "M30\n";
}

std::string klartext_passes() {
  std::string text = "0 BEGIN PGM PASSES MM\n1 TOOL CALL 1 Z S2000\n2 L X+0 Y+0 Z+5 R0 FMAX M3\n";
  int n = 3;
  for (int i = 0; i < 12; ++i) {
    for (const char* block : {"L Z-1 F50", "L X+300 F50 ; pass", "CC X+300 Y+10", "C X+310 Y+10 DR+", "L Y+20", "L X+0 F60",
                              "L Z+5 FMAX", "L X+0 Y+0 FMAX"})
      text += std::to_string(n++) + " " + block + "\n";
  }
  return text + std::to_string(n) + " M30\n" + std::to_string(n + 1) + " END PGM PASSES MM\n";
}

std::string din_passes() {
  std::string text = "%PASSES G71 *\nN10 T1 G17 S2000 *\nN20 G00 G40 G90 X+0 Y+0 Z+5 M3 *\n";
  int n = 30;
  for (int i = 0; i < 12; ++i) {
    for (const char* block :
         {"G01 Z-1 F50", "X+300 F50", "G03 X+310 Y+10 I+300 J+10", "G01 Y+20", "X+0 F60", "G00 Z+5", "G00 X+0 Y+0"})
      text += fmt::format("N{} {} *\n", n += 10, block);
  }
  return text + "N99990 M30 *\nN99999 %PASSES G71 *\n";
}

TEST(ScheduleVerb, ReadsAndCorrectsProgramsInTheLanguageOfTheirControl) {
  const std::string with_tools = std::string(kScheduledHead) + "  tool_change: 10 s\n";
  const Scheduled siemens = run_schedule("siemens", siemens_passes(), "--dialect siemens", with_tools);
  ASSERT_EQ(siemens.outcome.exit_code, 0) << siemens.outcome.output;
  EXPECT_THAT(read_text(siemens.folder / "part.ngc"),
              AllOf(HasSubstr("$P_BFRAME[Z,TR]=$P_UBFR[Z,TR]-0.0"), HasSubstr("N20 MSG(\"passes\")\n"),
                    Not(HasSubstr("G10")), Not(HasSubstr("G52"))));
  EXPECT_THAT(siemens.outcome.output,
              AllOf(HasSubstr("Siemens (G290)"), HasSubstr("no SINUMERIK has run this program here")));
  const Scheduled din = run_schedule("din", din_passes(), "--dialect heidenhain", with_tools);
  ASSERT_EQ(din.outcome.exit_code, 0) << din.outcome.output;
  EXPECT_THAT(read_text(din.folder / "part.ngc"),
              AllOf(ContainsRegex("\nN[0-9]+ G54 G91 .*Z-0.0[0-9]* \\*\nN[0-9]+ G90 \\*\n"),
                    HasSubstr("\nN99990 M30 *\nN99999 %PASSES G71 *\n")));
  const Scheduled klartext = run_schedule("klartext", klartext_passes(), "--dialect heidenhain", with_tools);
  ASSERT_EQ(klartext.outcome.exit_code, 0) << klartext.outcome.output;
  EXPECT_THAT(
      read_text(klartext.folder / "part.ngc"),
      AllOf(ContainsRegex("CYCL DEF 7.0 DATUM SHIFT\n[0-9]+ CYCL DEF 7.1 I[XZ]"), HasSubstr(" END PGM PASSES MM\n")));
  EXPECT_THAT(klartext.outcome.output, HasSubstr("no TNC has run this program here"));
  // The same motions make the same drift and the same corrections.
  const auto last = [](const Scheduled& s) {
    return read_record_csv((s.folder / "record.csv").string()).at("nose_z").values.back();
  };
  EXPECT_NEAR(last(din), last(klartext), 1e-6);
  EXPECT_EQ(run_schedule("foreign", passes(), "--dialect siemens").outcome.exit_code, 2);
  EXPECT_EQ(run_schedule("foreign_h", passes(), "--dialect heidenhain").outcome.exit_code, 2);
}

TEST(ScheduleVerb, LinuxCncAcceptsTheProgramAndRunsTheSamePath) {
  for (const char* arguments : {"--policy paper", "--policy minimal", "--policy minimal --split"}) {
    const Scheduled s = run_schedule("rs274", passes(), arguments);
    ASSERT_EQ(s.outcome.exit_code, 0) << s.outcome.output;
    if (!has_rs274()) GTEST_SKIP() << kNoRs274;
    const Path original = rs274(s.folder.parent_path() / "part.ngc"), corrected = rs274(s.folder / "part.ngc");
    ASSERT_TRUE(original.accepted) << original.said;
    ASSERT_TRUE(corrected.accepted) << corrected.said;
    ASSERT_GT(original.motions.size(), 80u);
    EXPECT_EQ(corrected.motions, original.motions) << arguments;
    const auto table = lines_of(read_text(s.folder / "schedule.csv"));
    EXPECT_EQ(corrected.offsets_mm.size(), table.size() - 2 + original.offsets_mm.size() + 1)
        << "each row one offset, one behind";
    EXPECT_GT(corrected.offsets_mm.size(), 4u);
    EXPECT_EQ(corrected.offsets_mm.back(), (std::array<double, 3>{0, 0, 0}));
    double lowest_mm = 0.0;
    for (const auto& offset : corrected.offsets_mm) lowest_mm = std::min(lowest_mm, offset[2]);
    EXPECT_LT(lowest_mm, -0.02);
    EXPECT_GT(lowest_mm, -0.1);
  }
}

// rs274 refuses G10 with cutter compensation on: the offset comes before G41.
TEST(ScheduleVerb, LinuxCncAcceptsAProgramThatBeginsWithAContour) {
  const Scheduled s = run_schedule("contour",
                                   "G21 G90 G17 G54 G94\nS2000 M3\nG41 D0\nG0 X10 Y10 Z5\nG1 X200 F20\nG1 Y100\n"
                                   "G40 G0 X0\nG0 Z9\nM30\n");
  ASSERT_EQ(s.outcome.exit_code, 0) << s.outcome.output;
  if (!has_rs274()) GTEST_SKIP() << kNoRs274;
  const Path path = rs274(s.folder / "part.ngc");
  EXPECT_TRUE(path.accepted) << path.said;
}

// The machine is known up to 2000 rpm: a word with a zero too many is no plan.
TEST(ScheduleVerb, RefusesASpeedThatTheScenarioSaysNothingOf) {
  const std::string fast = "G21 G90 G54\nS2000 M3\nG0 X0 Z5\nS60000 M3\nG1 X100 F5\nG0 Z9\nM30\n";
  const Scheduled refused = run_schedule("too_fast", fast);
  EXPECT_EQ(refused.outcome.exit_code, 2);
  EXPECT_THAT(refused.outcome.output,
              AllOf(HasSubstr("part.ngc:5"), HasSubstr("turns at 60000 rpm"), HasSubstr("--beyond")));
  EXPECT_FALSE(std::filesystem::exists(refused.folder / "part.ngc"));
}

/// The rows of schedule.csv as numbers; empty cells are NaN.
std::vector<std::map<std::string, double>> rows_of(const Scheduled& s) {
  std::vector<std::map<std::string, double>> rows;
  std::vector<std::string> header;
  for (const std::string& line : lines_of(read_text(s.folder / "schedule.csv"))) {
    if (line.starts_with("#")) continue;
    std::vector<std::string> cells = {""};
    for (const char c : line) {
      if (c == ',') {
        cells.emplace_back();
      } else {
        cells.back().push_back(c);
      }
    }
    if (header.empty()) {
      header = cells;
      continue;
    }
    rows.emplace_back();
    for (std::size_t i = 0; i < header.size(); ++i)
      rows.back()[header[i]] = cells.at(i).empty() ? std::nan("") : std::stod(cells[i]);
  }
  return rows;
}

// Five minutes at 2000 rpm, six at 60000 rpm, which heat by 0.15 K/s, and on at 2000 rpm. Each block of the fast stretch
// would need corrections of its own.
TEST(ScheduleVerb, BeyondLimitsTheCorrectionIsHeldAndThatIsSaid) {
  const Scheduled s = run_schedule("beyond",
                                   "G21 G90 G54\nS2000 M3\nG0 X0 Z5\nG1 X100 F20\nS60000\nG1 X0 F50\nG1 X100\nG1 X0\n"
                                   "S2000\nG0 Z6\nG1 X100 F50\nG0 Z9\nM30\n",
                                   "--beyond");
  ASSERT_EQ(s.outcome.exit_code, 0) << s.outcome.output;
  double after_um = 0.0;
  for (const auto& row : rows_of(s)) {
    const double line = row.at("line");
    EXPECT_FALSE(line >= 5 && line <= 8) << "a change at line " << line;
    if (line >= 9 && std::isfinite(row.at("z_correction_um"))) after_um = row.at("z_correction_um");
  }
  EXPECT_GT(after_um, 100.0) << "corrected again where the speed is known";
  EXPECT_THAT(s.outcome.output, AllOf(HasSubstr("beyond the limits of the machine"), HasSubstr("lines 6 to 8"),
                                      HasSubstr("is extrapolated"), HasSubstr("at most 2000 rpm is allowed")));
  EXPECT_THAT(read_text(s.folder / "report.html"), HasSubstr("The program goes beyond the limits of the machine"));
  EXPECT_THAT(read_text(s.folder / "part.ngc"), HasSubstr("(driftwright: BEYOND THE LIMITS."));
  const nlohmann::json summary = nlohmann::json::parse(read_text(s.folder / "summary.json"));
  ASSERT_EQ(summary["beyond_limits"].size(), 1U);
  EXPECT_EQ(summary["beyond_limits"][0]["limit"], "speed");
  EXPECT_EQ(summary["beyond_limits"][0]["where"], "lines 6 to 8");
}

struct Limited {
  const char* name;
  const char* limits;
  const char* where;
  const char* message;
};

class ScheduleLimit : public ::testing::TestWithParam<Limited> {};

TEST_P(ScheduleLimit, RefuseTheBlockWithItsLineAndPlanWithBeyond) {
  const std::string scenario = std::string(kScheduledHead) + "limits: " + GetParam().limits + "\n";
  const std::string name = std::string("limit_") + GetParam().name;
  const Scheduled refused = run_schedule(name, passes(), "", scenario);
  EXPECT_EQ(refused.outcome.exit_code, 2) << refused.outcome.output;
  EXPECT_THAT(refused.outcome.output,
              AllOf(HasSubstr(GetParam().where), HasSubstr(GetParam().message), HasSubstr("--beyond")));
  EXPECT_FALSE(std::filesystem::exists(refused.folder / "part.ngc"));
  const Scheduled planned = run_schedule(name + "_beyond", passes(), "--beyond", scenario);
  ASSERT_EQ(planned.outcome.exit_code, 0) << planned.outcome.output;
  EXPECT_THAT(planned.outcome.output, HasSubstr("The program goes beyond the limits of the machine"));
}

// Of passes(): line 5 is the first feed, F50; line 7 is the arc to X310.
INSTANTIATE_TEST_SUITE_P(Each, ScheduleLimit,
                         ::testing::Values(Limited{"feed", "{speed: 2500 rpm, feed: 49 mm/min}", "part.ngc:5",
                                                   "the feed is 50 mm/min; at most 49 mm/min"},
                                           Limited{"travel", "{travel: {x: [-1 mm, 305 mm]}}", "part.ngc:7",
                                                   "X goes to 310 mm; the travel ends at 305 mm"},
                                           Limited{"correction", "{correction: 15 um}",
                                                   "part.ngc:", "but `correction` of `limits`"},
                                           Limited{"step", "{step: 3 um}", "part.ngc:", "but `step` of `limits`"}),
                         [](const auto& each) { return each.param.name; });

// The feed that is written is above what the machine's rapids do.
TEST(ScheduleVerb, RefusesAFeedAboveTheRapids) {
  const Scheduled s = run_schedule("fast_feed", "G21 G90 G54\nS2000 M3\nG0 X0 Z5\nG1 X100 F12000\nG0 Z9\nM30\n");
  EXPECT_EQ(s.outcome.exit_code, 2);
  EXPECT_THAT(s.outcome.output, AllOf(HasSubstr("part.ngc:4"), HasSubstr("12000 mm/min; at most 10000 mm/min"),
                                      HasSubstr("`rapid` of `schedule`")));
}

TEST(ScheduleVerb, TakesTheSpeedOfTheLimitsInPlaceOfTheScenarios) {
  const std::string program = "G21 G90 G54\nS3000 M3\nG0 X0 Z5\nG1 X100 F20\nG0 Z9\nM30\n";
  const auto with = [](const char* limits) { return std::string(kScheduledHead) + "limits: {speed: " + limits + "}\n"; };
  EXPECT_EQ(run_schedule("limit_unstated", program).outcome.exit_code, 2);
  EXPECT_EQ(run_schedule("limit_higher", program, "", with("3000 rpm")).outcome.exit_code, 0);
  const Scheduled lower = run_schedule("limit_lower", program, "", with("2999 rpm"));
  EXPECT_EQ(lower.outcome.exit_code, 2);
  EXPECT_THAT(lower.outcome.output, AllOf(HasSubstr("part.ngc:3"), HasSubstr("at most 2999 rpm"), HasSubstr("`limits`")));
}

TEST(ScheduleVerb, KeepsTheLimitsOfCorrectionsAndWritesThemIntoTheProgram) {
  const auto largest = [](const Scheduled& s, const char* column) {
    double most_um = 0.0;
    const auto rows = rows_of(s);
    for (std::size_t i = 1; i < rows.size(); ++i) {
      for (const char* axis : {"x_", "z_"}) {
        const double um = rows[i].at(std::string(axis) + column);
        if (std::isfinite(um)) most_um = std::max(most_um, std::abs(um));
      }
    }
    return most_um;
  };
  const Scheduled free = run_schedule("limits_none", passes());
  ASSERT_GT(largest(free, "correction_um"), 30.0);
  ASSERT_GT(largest(free, "increment_um"), 9.0);
  EXPECT_THAT(read_text(free.folder / "part.ngc"), Not(HasSubstr("limit of the scenario")));
  const std::string small = std::string(kScheduledHead) + "limits: {correction: 15 um, step: 9 um}\n",
                    large = std::string(kScheduledHead) + "limits: {correction: 80 um, step: 60 um}\n";
  const Scheduled held = run_schedule("limits_small", passes(), "--beyond", small);
  ASSERT_EQ(held.outcome.exit_code, 0) << held.outcome.output;
  EXPECT_LE(largest(held, "correction_um"), 15.0);
  EXPECT_LE(largest(held, "increment_um"), 9.0);
  const Scheduled within = run_schedule("limits_large", passes(), "", large);
  ASSERT_EQ(within.outcome.exit_code, 0) << within.outcome.output;
  EXPECT_EQ(read_text(within.folder / "schedule.txt"), read_text(free.folder / "schedule.txt"));
  EXPECT_THAT(read_text(within.folder / "part.ngc"),
              AllOf(HasSubstr("(driftwright: no correction is larger than 80 um"),
                    HasSubstr("(driftwright: no correction changes by more than 60 um at once")));
}

TEST(ScheduleVerb, NotesHaltsAndALastBlockThatMoves) {
  const Scheduled s = run_schedule("notes", "G21 G90 G54\nS2000 M3\nG0 X0 Z5\nG1 X100 F5\nM0\nG0 X0\nG0 X9 M30\n");
  ASSERT_EQ(s.outcome.exit_code, 0) << s.outcome.output;
  EXPECT_THAT(s.outcome.output,
              AllOf(HasSubstr("line 5: M0: a halt counts as no time"), HasSubstr("line 7: the last block moves")));
}

TEST(ScheduleVerb, NamesBlocksThatCannotKeepTheToleranceAndDividesThem) {
  const std::string slow = "G21 G90 G54\nS2000 M3\nG0 X0 Y0 Z0\nG1 X600 F10\nG0 Z5\nM30\n";
  const Scheduled whole = run_schedule("whole", slow);
  ASSERT_EQ(whole.outcome.exit_code, 0) << whole.outcome.output;
  EXPECT_THAT(whole.outcome.output, ContainsRegex("line 4 +z .* 60.0  --split divides it\n"));
  const Scheduled parts = run_schedule("parts", slow, "--split");
  EXPECT_THAT(parts.outcome.output, AllOf(HasSubstr("blocks divided  1\n"), Not(HasSubstr("beyond"))));
  EXPECT_THAT(read_text(parts.folder / "part.ngc"), AllOf(HasSubstr(" F10\nG52 "), HasSubstr("\nG1 X600 F10\n")));
  if (!has_rs274()) GTEST_SKIP() << kNoRs274;
  const Path path = rs274(parts.folder / "part.ngc");
  EXPECT_TRUE(path.accepted) << path.said;
  double x_mm = 100.0;  // G54 of this scenario; the machine's own is 0
  for (const std::string& motion : path.motions) {
    if (!motion.starts_with("STRAIGHT_FEED(")) continue;
    const std::vector<double> here = end_of(motion);  // always onward along x, at y = z = 0
    EXPECT_GT(here[0] + 1e-3, x_mm - 100.0);
    EXPECT_EQ(here[1], 0.0);
    EXPECT_EQ(here[2], 0.0);
    x_mm = here[0] + 100.0;
  }
  EXPECT_EQ(x_mm, 700.0);
}

TEST(ScheduleVerb, NamesAnUnreadableBlockAndWritesNothing) {
  const Scheduled s = run_schedule("unreadable", "G21\nG0 X0\nG1 X1O F100\nM30\n");
  EXPECT_EQ(s.outcome.exit_code, 2);
  EXPECT_THAT(s.outcome.output, AllOf(HasSubstr("part.ngc:3:"), HasSubstr("G1 X1O F100")));
  EXPECT_FALSE(std::filesystem::exists(s.folder));
}

struct BadSchedule {
  const char* name;
  const char* right;
  const char* wrong;
  const char* message;
};

class ScheduleMistakes : public ::testing::TestWithParam<BadSchedule> {};

TEST_P(ScheduleMistakes, EndWithTwoAndNameTheKey) {
  const std::string scenario = fixtures::replaced(kScheduledHead, GetParam().right, GetParam().wrong);
  const Scheduled s = run_schedule(std::string("bad_") + GetParam().name, passes(), "", scenario);
  EXPECT_EQ(s.outcome.exit_code, 2) << s.outcome.output;
  EXPECT_THAT(s.outcome.output, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Each, ScheduleMistakes,
    ::testing::Values(BadSchedule{"no_base", "  rapid: 10 m/min\n", "  rapid: 10 m/min\n  offset: absolute\n",
                                  "absolute offsets require `base_offset`"},
                      BadSchedule{"base_of_an_addition", "  rapid: 10 m/min\n",
                                  "  rapid: 10 m/min\n  base_offset: [0 mm, 0 mm, 0 mm]\n", "write `offset: absolute`"},
                      BadSchedule{"sign", "sign: -1", "sign: minus", "'minus' is not known here"},
                      BadSchedule{"channel", "displacement: nose_x", "displacement: nose_q", "'nose_q' is not known here"},
                      BadSchedule{"nobody_along_y", "x: {displacement: nose_x, sign: -1, tolerance: 4 um}", "y: {}",
                                  "no displacement is along y"},
                      BadSchedule{"tolerance", "tolerance: 10 um", "tolerance: 0 um", "schedule.tolerance"},
                      BadSchedule{"policy", "  tolerance: 10 um", "  policy: greedy", "'greedy' is not known here"},
                      BadSchedule{"unknown_key", "  tolerance: 10 um", "  tolerances: 10 um", "unknown key 'tolerances'"},
                      BadSchedule{"unknown_limit",
                                  "cyclograms:", "limits: {sped: 3 rpm}\ncyclograms:", "unknown key 'sped'"},
                      BadSchedule{"unit_of_a_limit", "cyclograms:", "limits: {step: 3 K}\ncyclograms:", "wrong unit"},
                      BadSchedule{"travel_upside_down", "cyclograms:", "limits: {travel: {x: [3 mm, 1 mm]}}\ncyclograms:",
                                  "the lowest and the highest position"},
                      BadSchedule{"cyclogram_above_a_limit", "cyclograms:", "limits: {speed: 1500 rpm}\ncyclograms:",
                                  "cyclogram 'warm_up' turns the spindle at 2000 rpm"},
                      BadSchedule{"no_rapid", "  rapid: 10 m/min\n", "", "state `rapid`"},
                      BadSchedule{"work_offset", "  tolerance: 10 um", "  work_offset: G55", "write `offset: absolute`"}),
    [](const auto& each) { return each.param.name; });

TEST(ScheduleVerb, ShowsWhatToWriteWhereTheScenarioSaysNothing) {
  const std::string scenario = std::string(kScheduledHead).substr(0, std::string(kScheduledHead).find("schedule:"));
  const Scheduled s = run_schedule("no_block", passes(), "", scenario);
  EXPECT_EQ(s.outcome.exit_code, 2);
  EXPECT_THAT(s.outcome.output, AllOf(HasSubstr("head.yaml"), HasSubstr("schedule: {tolerance: 10 um, rapid: 15 m/min}")));
}

TEST(ScheduleVerb, WantsAProgramAndKnownPolicies) {
  EXPECT_EQ(run_program("schedule scenarios/fp3_spindle.yaml").exit_code, 2);
  EXPECT_EQ(run_schedule("policy", passes(), "--policy none").outcome.exit_code, 2);
  const CommandOutcome help = run_program("schedule --help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.output,
              HasSubstr("driftwright schedule scenarios/fp3_spindle.yaml --program scenarios/parts/fp3_part.ngc"));
}

// The shipped part on the shipped machine. Each axis ends inside its 10 um, and LinuxCNC reads what is written.
TEST(Fp3Part, KeepsTheToleranceOfThePaper) {
  const auto folder = fresh_folder("fp3_part") / "out";
  const CommandOutcome outcome =
      run_program("schedule scenarios/fp3_spindle.yaml --program scenarios/parts/fp3_part.ngc -o " + folder.string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output,
              AllOf(HasSubstr("5 operations"), Not(HasSubstr("The tolerance is left")), Not(HasSubstr("beyond"))));
  if (!has_rs274()) GTEST_SKIP() << kNoRs274;
  std::filesystem::copy_file("scenarios/parts/fp3_part.ngc", folder.parent_path() / "fp3_part.ngc");
  const Path before = rs274(folder.parent_path() / "fp3_part.ngc"), after = rs274(folder / "fp3_part.ngc");
  EXPECT_TRUE(after.accepted) << after.said;
  EXPECT_EQ(after.motions, before.motions);
  EXPECT_GT(after.offsets_mm.size(), before.offsets_mm.size() + 3);
}

}  // namespace
}  // namespace driftwright::schedule_verb_test
