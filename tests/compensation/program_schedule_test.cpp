// Corrections of whole programs, judged by following the corrected text as a control does.

#include "compensation/schedule/program_schedule.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <sstream>

#include "compensation/sensors/interpolate.hpp"
#include "nc/program.hpp"
#include "tests/shared/edited_text.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::compensation::program_schedule_test {
namespace {

using fixtures::lines_of;
using ::testing::HasSubstr;

NcProgram read(const std::string& text) {
  const NcSettings settings{.rapid_m_s = 0.1,
                            .tool_change_s = 8.0,
                            .dwell_P_s = 1.0,
                            .machine_zero_m = std::array<double, 3>{0, 0, 0.2},
                            .ignored = {}};
  return read_nc_program(write_file("program_schedule_test.ngc", text), settings);
}

struct Corrected {
  ProgramSchedule plan;
  std::string text;
};

Corrected correct(const std::string& text, const NcProgram& program, const std::vector<double>& time_s,
                  const std::vector<ProgramAxis>& axes, const ProgramScheduleOptions& options) {
  Corrected c{plan_program(program.steps, time_s, axes, options), {}};
  NcOffsetOptions offsets{
      .language = program.language, .absolute = true, .work_offset = 540, .base_m = {0.25, 0, 0}, .axes = {}};
  for (const ProgramAxis& axis : axes) offsets.axes[axis.axis] = true;
  c.text =
      corrected_nc_program(text, program.steps, initial_shift_m(c.plan, axes), offset_changes(c.plan, axes), offsets).text;
  return c;
}

std::map<char, double> words_of(const std::string& line) {
  std::map<char, double> words;
  std::istringstream stream(line);
  for (std::string word; stream >> word;) words[word[0]] = std::stod(word.substr(1));
  return words;
}

/// Follows a corrected program as a control does: an offset moves nothing, an axis takes it when it is commanded next.
/// Blocks take the time that they take in `program`, lines of our own none; divided blocks advance to the share of their
/// way. Returns the largest |drift - correction| of each axis over samples of each block; written with nothing of the
/// planner.
std::array<double, 3> follow(const std::vector<std::string>& original, const std::vector<std::string>& corrected,
                             const NcProgram& program, const std::vector<double>& time_s,
                             const std::vector<ProgramAxis>& axes) {
  std::array<double, 3> worst = {0, 0, 0};
  std::array<double, 3> base_mm = {250, 0, 0}, offset_mm = base_mm, taken_mm = base_mm;
  std::size_t step = 0, line = 0;  // of the original
  double now_s = 0.0;
  const auto go = [&](double until_s, const std::array<double, 3>& to_mm) {
    for (const ProgramAxis& axis : axes) {
      for (int i = 0; i <= 20; ++i) {
        const double share = i / 20.0, t_s = std::min(now_s + share * (until_s - now_s), time_s.back());
        const double shift_mm = taken_mm[axis.axis] + share * (to_mm[axis.axis] - taken_mm[axis.axis]) - base_mm[axis.axis];
        const double correction_um = -axis.sign * 1e3 * shift_mm;
        const double left_um = interpolate(time_s, axis.drift_um, t_s) - correction_um;
        worst[axis.axis] = std::max(worst[axis.axis], std::abs(left_um));
      }
    }
    now_s = until_s;
    taken_mm = to_mm;
  };
  for (const std::string& text : corrected) {
    if (text.starts_with("(driftwright: ")) continue;
    if (text.starts_with("G10 L2 P1 ")) {
      for (const auto& [letter, value] : words_of(text.substr(10))) offset_mm[letter - 'X'] = value;
      continue;
    }
    const NcStep* now = step < program.steps.size() ? &program.steps[step] : nullptr;
    if (line < original.size() && text == original[line]) {
      ++line;
      if (!now || now->where.line != static_cast<int>(line)) continue;  // a comment
      std::array<double, 3> to_mm = taken_mm;
      for (int axis = 0; axis < 3; ++axis) {
        if (now->kind == NcStepKind::kMachine) {
          to_mm[axis] = base_mm[axis];
        } else if (now->named[axis] && now->absolute && !now->deletable) {
          to_mm[axis] = offset_mm[axis];
        }
      }
      if (now->end_s > now_s) go(now->end_s, to_mm);
      taken_mm = to_mm;
      ++step;
      continue;
    }
    const std::map<char, double> words = words_of(text);  // a line of ours: to the point on the block's way, or once more
    std::array<double, 3> to_mm = taken_mm;
    double until_s = now_s;
    for (int axis = 0; axis < 3; ++axis) {
      const auto word = words.find(static_cast<char>('X' + axis));
      if (word == words.end()) continue;
      to_mm[axis] = offset_mm[axis];
      const double whole_mm = 1e3 * (now->end_m[axis] - now->start_m[axis]);
      if (whole_mm != 0.0) {
        const double share = (word->second - 1e3 * now->start_m[axis]) / whole_mm;
        until_s = std::max(until_s, now->start_s + share * now->duration_s());
      }
    }
    if (until_s > now_s + 1e-9) go(until_s, to_mm);
    taken_mm = to_mm;
  }
  EXPECT_EQ(line, original.size()) << "a line of the program is missing or changed";
  EXPECT_EQ(step, program.steps.size());
  return worst;
}

/// Passes to and fro at depth, with retracts, arcs, a canned cycle and a tool change.
std::string milling(std::mt19937& random) {
  std::uniform_real_distribution<double> where(0.0, 100.0);
  std::string text = "G21 G90 G17 G54\nT1 M6\nS1000 M3\nG0 X0 Y0 Z5\n";
  for (int i = 0; i < 40; ++i) {
    const auto x = [&] { return std::to_string(where(random)).substr(0, 5); };
    switch (i % 8) {
      case 0:
        text += "G0 Z5\nG0 X" + x() + " Y" + x() + "\nG1 Z-1 F100\n";
        break;
      case 3:
        text += "G2 X10 Y10 I5 J5 F80\n";
        text.replace(text.rfind("G2"), std::string::npos, "G1 X10 Y10 F80\nG2 X20 Y20 I5 J5\nX10 Y10 I-5 J-5\n");
        break;
      case 5:
        text += "G0 Z5\nG81 X" + x() + " Z-3 R2 F100\nX" + x() + "\nG80\n";
        break;
      case 7:
        text += "G91\nG1 X3 F60\nY-2\nG90\n(a comment)\n";
        break;
      default:
        text += "G1 X" + x() + " F70\nY" + x() + "\n";
    }
    if (i == 20) text += "G0 Z50\nT2 M6\nM3\n";
  }
  return text + "G0 Z50\nG4 P30\nM30\n";
}

/// A drift of some tens of um, slow enough for every block.
std::vector<double> drift(std::mt19937& random, const std::vector<double>& time_s) {
  std::uniform_real_distribution<double> amount(10.0, 40.0), phase(0.0, 6.28);
  const double a = amount(random), b = amount(random), p = phase(random), end_s = time_s.back();
  std::vector<double> d;
  for (double t : time_s)
    d.push_back(a * (1.0 - std::exp(-3.0 * t / end_s)) + b * (std::sin(4.0 * t / end_s + p) - std::sin(p)));
  return d;
}

TEST(ProgramSchedule, KeepsTheToleranceInTheProgramAsAControlRunsIt) {
  std::mt19937 random(3);
  int n_kept = 0;
  for (int trial = 0; trial < 24; ++trial) {
    const std::string text = milling(random);
    const NcProgram program = read(text);
    std::vector<double> time_s;
    for (int i = 0; i < 200; ++i) time_s.push_back(program.duration_s() * i / 200.0);
    time_s.push_back(program.duration_s());
    const std::vector<ProgramAxis> axes = {
        {0, 1.0, 10.0, drift(random, time_s)}, {1, 1.0, 8.0, drift(random, time_s)}, {2, -1.0, 6.0, drift(random, time_s)}};
    const SchedulePolicy policy = trial % 2 == 0 ? SchedulePolicy::kMinimal : SchedulePolicy::kPaper;
    const Corrected c = correct(text, program, time_s, axes, {.policy = policy, .split = trial % 4 > 1});
    const std::array<double, 3> worst = follow(lines_of(text), lines_of(c.text), program, time_s, axes);
    n_kept += static_cast<int>(c.plan.long_stretches.empty());
    for (std::size_t a = 0; a < axes.size(); ++a) {
      // A rapid of seconds may hold a sample of the drift, whose bend the way between two corrections does not follow:
      // nanometres.
      double told = axes[a].tolerance_um;  // or what the plan says of a canned cycle that is too long for this drift
      for (const LongStretch& s : c.plan.long_stretches) {
        if (s.axis == a) told = std::max(told, std::abs(s.residual_um));
      }
      EXPECT_LE(worst[a], told + 0.01) << "trial " << trial << " axis " << a;
      EXPECT_GT(worst[a], 0.5 * axes[a].tolerance_um);  // held, not chased
      double planned = 0.0;
      for (double r : c.plan.courses[a].residual_um) planned = std::max(planned, std::abs(r));
      EXPECT_NEAR(planned, worst[a], 0.3) << "the course told is not the one run";
    }
  }
  EXPECT_GE(n_kept, 20);
}

TEST(ProgramSchedule, LeavesEveryLineAsItWas) {
  std::mt19937 random(5);
  std::string text = milling(random);
  std::string crlf;
  for (char ch : text) crlf += ch == '\n' ? std::string("\r\n") : std::string(1, ch);
  const NcProgram program = read(crlf);
  const std::vector<double> time_s = {0, program.duration_s()};
  const std::vector<ProgramAxis> axes = {{0, 1.0, 5.0, {0, 80}}, {2, 1.0, 5.0, {0, -60}}};
  const Corrected c = correct(crlf, program, time_s, axes, {.policy = SchedulePolicy::kPaper});
  ASSERT_GT(c.plan.changes.size(), 15u);
  std::string left;  // without the lines that are not in the original, in order
  std::size_t next = 0;
  const std::vector<std::string> original = lines_of(crlf);
  int ours = 0;
  for (const std::string& line : lines_of(c.text)) {
    if (next < original.size() && line == original[next]) {
      left += line + "\n";
      ++next;
    } else {
      EXPECT_TRUE(line.starts_with("(driftwright: ") || line.starts_with("G10 L2 P1 ") || line.starts_with("G0 ") ||
                  line.starts_with("G1 ") || line.starts_with("G90 ") || line == "G91\r")
          << line;
      EXPECT_TRUE(line.ends_with('\r'));
      ++ours;
    }
  }
  EXPECT_EQ(left, crlf);
  EXPECT_GT(ours, 15);
}

// Passes to and fro with rapids between. X is named by every fourth block as a rapid, and 25 um take one change with much
// freedom.
TEST(ProgramSchedule, PrefersARapidThatNamesTheAxis) {
  std::string text = "G21\nG0 X0 Y0 Z5\n";
  for (int i = 0; i < 10; ++i) text += "G1 X60 F60\nG0 Y" + std::to_string(i) + "\nG1 X0\nG0 X1 Z5\n";
  text += "M2\n";
  const NcProgram program = read(text);
  const double end_s = program.duration_s();
  const std::vector<ProgramAxis> axes = {{0, 1.0, 10.0, {0, 25.0}}};
  const Corrected c = correct(text, program, std::vector<double>{0, end_s}, axes, {});
  ASSERT_EQ(c.plan.changes.size(), 1u);
  const NcStep& step = program.steps[c.plan.changes[0].step];
  EXPECT_EQ(step.kind, NcStepKind::kRapid);
  EXPECT_TRUE(step.named[0]);
  // The remark, in front, the change, at the end: no line that commands the axis once more.
  EXPECT_EQ(lines_of(c.text).size(), lines_of(text).size() + 4);
}

constexpr const char* kLongPass = "G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X600 Y300 F10 (one pass of 67 min)\nG0 Z5\nM2\n";

TEST(ProgramSchedule, NamesALongBlockWithItsMicrometresAndDividesIt) {
  const NcProgram program = read(kLongPass);
  const double end_s = program.duration_s();
  const std::vector<double> time_s = {0, end_s / 3.0, end_s};
  const std::vector<ProgramAxis> axes = {{0, 1.0, 5.0, {0, 20, 40}}, {2, -1.0, 5.0, {0, -10, -12}}};
  const Corrected whole = correct(kLongPass, program, time_s, axes, {});
  ASSERT_EQ(whole.plan.long_stretches.size(), 2u);
  const LongStretch& s = whole.plan.long_stretches[0];
  EXPECT_EQ(program.steps[s.first].where.line, 4);
  EXPECT_EQ(s.not_divisible, "");
  EXPECT_NEAR(std::abs(s.residual_um), 20.0, 0.2);  // half of the 40 um that it moves by, but for the plunge
  for (SchedulePolicy policy : {SchedulePolicy::kMinimal, SchedulePolicy::kPaper}) {
    const Corrected parts = correct(kLongPass, program, time_s, axes, {.policy = policy, .split = true});
    EXPECT_TRUE(parts.plan.long_stretches.empty());
    EXPECT_EQ(parts.plan.n_divided, 1);
    const std::array<double, 3> worst = follow(lines_of(kLongPass), lines_of(parts.text), program, time_s, axes);
    EXPECT_LE(worst[0], 5.01);
    EXPECT_LE(worst[2], 5.01);
    for (const std::string& line :
         lines_of(parts.text)) {  // points exactly on the way: y = x / 2, and the feed of the block
      const std::map<char, double> words =
          line.starts_with("G1 X") && line.ends_with(" F10") ? words_of(line) : std::map<char, double>{};
      if (words.empty()) continue;
      EXPECT_NEAR(words.at('Y'), 0.5 * words.at('X'), 2e-6);
    }
    EXPECT_THAT(parts.text, HasSubstr("F10\nG10 L2 P1 "));
    EXPECT_THAT(parts.text, HasSubstr("G1 X600 Y300 F10 (one pass of 67 min)\n"));
  }
}

TEST(ProgramSchedule, SaysWhatCannotBeDivided) {
  const std::string text = "G21\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG2 X0 Y0 I200 F10\nG4 P9000\nG0 Z5\nM2\n";
  const NcProgram program = read(text);
  const std::vector<ProgramAxis> axes = {{0, 1.0, 5.0, {0, 60}}};
  const Corrected c = correct(text, program, std::vector<double>{0, program.duration_s()}, axes, {.split = true});
  ASSERT_EQ(c.plan.long_stretches.size(), 2u);
  EXPECT_EQ(c.plan.long_stretches[0].not_divisible, "an arc");
  EXPECT_EQ(c.plan.long_stretches[1].not_divisible, "the axes are at rest");
}

// The tool changes at 600 s: a second operation.
TEST(ProgramSchedule, BeginsAnOperationAtAToolChange) {
  const NcProgram program = read("G1 X100 F10\nG0 X0\nT1 M6\nM2\n");
  const std::vector<ProgramAxis> axes = {{0, 1.0, 5.0, {0, 1}}};
  const ProgramSchedule plan = plan_program(program.steps, std::vector<double>{0, program.duration_s()}, axes, {});
  ASSERT_EQ(plan.schedules[0].operations.size(), 2u);
  EXPECT_DOUBLE_EQ(plan.schedules[0].operations[1].start_s, 601.0);
  EXPECT_DOUBLE_EQ(plan.schedules[0].operations[1].end_s, 609.0);
  EXPECT_TRUE(plan.changes.empty());
}

// Z takes its 8 um at the end of the pass that names it first, and loses them at the machine's zero: the pass after that
// has none.
TEST(ProgramSchedule, CountsACorrectionFromTheBlockThatCommandsTheAxis) {
  const std::string text = "G21\nG0 X0\nG1 X200 F20\nG1 X0 Z1\nG1 X200\nG28\nG1 X50 F20\nG0 Z5\nG1 X9\nM2\n";
  const NcProgram program = read(text);
  const std::vector<double> time_s = {0, program.duration_s()};
  for (const double tolerance_um : {5.0, 10.0}) {
    const std::vector<ProgramAxis> axes = {{2, 1.0, tolerance_um, {8, 8}}};
    const Corrected c = correct(text, program, time_s, axes, {.policy = SchedulePolicy::kPaper});
    const AxisCourse& course = c.plan.courses[0];
    EXPECT_DOUBLE_EQ(course.worst_um, 8.0);
    EXPECT_NEAR(follow(lines_of(text), lines_of(c.text), program, time_s, axes)[2], 8.0, 1e-9);
    if (tolerance_um > 8.0) {
      EXPECT_TRUE(c.plan.long_stretches.empty());
      continue;
    }
    const auto has_um = [&](int line, double share) {
      const NcStep& step = program.steps[static_cast<std::size_t>(line) - 1];
      return interpolate(course.time_s, course.correction_um, step.start_s + share * step.duration_s());
    };
    EXPECT_DOUBLE_EQ(has_um(3, 0.5), 0.0);
    EXPECT_DOUBLE_EQ(has_um(4, 0.5), 2.5);
    EXPECT_DOUBLE_EQ(has_um(5, 0.5), 5.0);
    EXPECT_DOUBLE_EQ(has_um(7, 0.5), 0.0);
    EXPECT_DOUBLE_EQ(has_um(9, 0.5), 5.0);
    ASSERT_EQ(c.plan.long_stretches.size(), 1u);
    EXPECT_EQ(c.plan.long_stretches[0].first, 2u);
    EXPECT_EQ(c.plan.long_stretches[0].last, 6u);
    EXPECT_THAT(c.plan.long_stretches[0].not_divisible, HasSubstr("nobody has commanded the axis"));
  }
}

// Warm from the start, but nothing is cut before the axis is commanded: a tool change at 30 um counts for nothing.
TEST(ProgramSchedule, JudgesWhatIsCut) {
  const NcProgram program = read("T1 M6\nG0 X0 Z5\nG1 X50 F100\nM2\n");
  const std::vector<ProgramAxis> axes = {{2, 1.0, 5.0, {30, 30}}};
  const ProgramSchedule plan = plan_program(program.steps, std::vector<double>{0, program.duration_s()}, axes, {});
  EXPECT_DOUBLE_EQ(plan.courses[0].worst_um, 0.0);
  EXPECT_DOUBLE_EQ(plan.courses[0].residual_um.front(), 30.0);
}

TEST(ProgramSchedule, RefusesAnAxisThatNoBlockCommandsInG90) {
  for (const char* text : {"G0 X0\nG1 X9 F10\nM2\n", "G0 X0\nG91 G1 Z9 F10\nM2\n", "G0 X0\nG53 G0 Z0\nM2\n",
                           "G0 X0\n/G0 Z1\nM2\n", "G0 X0\nG0 Z1 M2\n"}) {
    const NcProgram program = read(text);
    const std::vector<ProgramAxis> axes = {{2, 1.0, 5.0, {0, 1}}};
    const std::vector<double> time_s = {0, program.duration_s()};
    EXPECT_REFUSED(plan_program(program.steps, time_s, axes, {}), "Z is never commanded in G90") << text;
  }
}

// A drift of 30 um from the start: the axis is 30 um too far, so its offset goes back; against the axis, forward.
TEST(ProgramSchedule, MovesTheAxisAgainstTheError) {
  const NcProgram program = read("G0 X1 Y1 Z1\nM2\n");
  const std::vector<double> time_s = {0, program.duration_s()};
  for (double sign : {1.0, -1.0}) {
    const std::vector<ProgramAxis> axes = {{2, sign, 5.0, {30, 30}}};
    const ProgramSchedule plan = plan_program(program.steps, time_s, axes, {});
    EXPECT_DOUBLE_EQ(plan.initial_um[2], 30.0);
    EXPECT_DOUBLE_EQ(initial_shift_m(plan, axes)[2], -sign * 30e-6);
  }
}

/// Passes to and fro along X, a minute each.
std::string to_and_fro() {
  std::string text = "G21\nG0 X0 Z5\n";
  for (int i = 0; i < 6; ++i) text += "G1 X60 F60\nX0\n";
  return text + "M2\n";
}

// 100 um in two passes alone, which are held: nothing is left to correct.
TEST(ProgramSchedule, HoldsTheCorrectionInHeldSteps) {
  const NcProgram program = read(to_and_fro());
  const double from_s = program.steps[6].start_s, to_s = program.steps[7].end_s, end_s = program.duration_s();
  const std::vector<double> time_s = {0, from_s, from_s + 1.0, to_s - 1.0, to_s, end_s};
  const std::vector<ProgramAxis> axes = {{0, 1.0, 5.0, {0, 0, 100, 100, 0, 0}}};
  ProgramScheduleOptions options;
  EXPECT_FALSE(plan_program(program.steps, time_s, axes, options).changes.empty());
  options.held_steps.assign(program.steps.size(), 0);
  options.held_steps[6] = options.held_steps[7] = 1;
  for (const bool split : {false, true}) {
    options.split = split;
    const ProgramSchedule plan = plan_program(program.steps, time_s, axes, options);
    EXPECT_TRUE(plan.changes.empty());
    EXPECT_EQ(plan.initial_um[0], 0.0);
    EXPECT_NEAR(plan.courses[0].worst_um, 100.0, 1e-9) << "what is left there is told";
  }
}

// A drift that rises from 0 to 60 um: it would be followed up to more than 50 um, by about 10 um at once.
TEST(ProgramSchedule, HoldsCorrectionsBeyondALimit) {
  const NcProgram program = read(to_and_fro());
  const std::vector<double> time_s = {0, program.duration_s()};
  const std::vector<ProgramAxis> axes = {{0, 1.0, 6.0, {0, 60}}};
  for (const SchedulePolicy policy : {SchedulePolicy::kMinimal, SchedulePolicy::kPaper}) {
    const ProgramSchedule free = plan_program(program.steps, time_s, axes, {.policy = policy});
    ASSERT_GT(*free.changes.back().correction_um[0], 40.0);
    EXPECT_TRUE(free.held.empty());
    const ProgramSchedule small = plan_program(program.steps, time_s, axes, {.policy = policy, .limits = {.most_um = 25.0}});
    ASSERT_FALSE(small.changes.empty());
    for (const ProgramChange& change : small.changes) EXPECT_LE(*change.correction_um[0], 25.0);
    ASSERT_EQ(small.held.size(), 1u);
    EXPECT_FALSE(small.held[0].is_step);
    EXPECT_GT(small.held[0].first, small.changes.back().step);
    EXPECT_EQ(small.held[0].last, program.steps.size() - 2) << "the last pass, before M2";
    EXPECT_EQ(small.held[0].held_um, *small.changes.back().correction_um[0]);
    EXPECT_GT(small.held[0].planned_um, 40.0);
    const ProgramSchedule slow =
        plan_program(program.steps, time_s, axes, {.policy = policy, .limits = {.most_step_um = 2.0}});
    EXPECT_TRUE(slow.changes.empty());
    ASSERT_EQ(slow.held.size(), 1u);
    EXPECT_TRUE(slow.held[0].is_step);
  }
}

}  // namespace
}  // namespace driftwright::compensation::program_schedule_test
