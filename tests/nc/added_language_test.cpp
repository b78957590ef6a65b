// A language of which the program knows nothing but this file: a program in it is recognised, read, timed, corrected,
// written and read again. Every byte that a language decides on is its own.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

#include "nc/correction.hpp"
#include "nc/execution.hpp"
#include "nc/places.hpp"
#include "nc/program.hpp"
#include "nc/units.hpp"
#include "nc/written_words.hpp"
#include "tests/nc/program_sums.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::added_language_test {
namespace {

using fixtures::on_line;
using ::testing::AllOf, ::testing::HasSubstr, ::testing::ThrowsMessage;

/// MARK first; UNIT MM, UNIT INCH; SPIN S600; JUMP X0 Z5; LINE X10 F300; SHIFT X0.1, which sets an added offset; ORIGIN X3,
/// which moves the origin by 3 and takes the added offset away; STOP; ! remarks. Blocks may have numbers, such as :7, and a
/// full stop.
class Marker final : public NcLanguage {
 public:
  std::string name() const override { return "Marker"; }
  bool recognises(const std::vector<std::string>& lines) const override {
    return !lines.empty() && lines.front().find("MARK") != std::string::npos;
  }

  void read(const std::string& path, const std::vector<std::string>& lines, NcExecution& run) const override {
    std::array<double, 3> shift_m = {0, 0, 0};
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const Where where{path, static_cast<int>(i) + 1, 1, "", lines[i]};
      run.count(where);
      run.begin(where, false);
      run.step().ends_program = block(lines[i], run, shift_m);
      run.end();
      if (run.step().ends_program) return;
    }
    throw InputError(path + ": the program has no STOP");
  }

  std::vector<std::string> offset_lines(const NcOffsetOptions& options, const NcShift& shift) const override {
    std::array<std::optional<double>, 3> x_m{};
    for (int axis = 0; axis < 3; ++axis) {
      if (shift.axes[axis]) x_m[axis] = shift.to_m[axis] + (options.absolute ? options.base_m[axis] : 0.0);
    }
    return {"SHIFT" + axis_words(x_m, shift.before.unit_m, written_length)};
  }
  std::vector<std::string> straight_lines(const NcLine& line) const override {
    const std::string words = axis_words(line.to_m, line.before.unit_m, written_length);
    return {(line.rapid ? "JUMP" : "LINE") + words + (line.feed.empty() ? "" : " " + line.feed)};
  }
  std::string remark_line(const std::string& text) const override { return "! " + text; }
  NcBlockForm block_form() const override { return {.number_letter = ":", .end = "."}; }
  std::string unit_words() const override { return "UNIT MM"; }
  std::string offset_name(const NcOffsetOptions& /*options*/) const override { return "SHIFT"; }
  std::string remark(const NcOffsetOptions& /*options*/) const override { return "corrections by SHIFT"; }
  std::string advice(bool /*absolute*/) const override { return "No marker has run this."; }

 private:
  /// @returns true  if it ends the program
  static bool block(const std::string& line, NcExecution& run, std::array<double, 3>& shift_m) {
    std::istringstream stream(line.substr(0, std::min(line.find('!'), line.find(" ."))));
    std::string verb;
    stream >> verb;
    if (verb.starts_with(':')) stream >> verb;
    std::map<char, std::string> words;
    for (std::string word; stream >> word;) words[word[0]] = word;
    const auto value = [&](char letter) { return std::stod(words.at(letter).substr(1)); };
    NcStep& step = run.step();
    if (verb == "UNIT") {
      run.unit_m = run.feed_unit_m = words.contains('I') ? kInch_m : kMillimetre_m;
      step.unit_word = true;
    } else if (verb == "SPIN") {
      run.motion.programmed_rpm = value('S');
      run.motion.turning = true;
    } else if (verb == "SHIFT" || verb == "ORIGIN") {
      for (int axis = 0; axis < 3; ++axis) {
        const char letter = "XYZ"[axis];
        if (!words.contains(letter)) continue;
        const double x_m = value(letter) * run.unit_m;
        run.motion.position_m[axis] += shift_m[axis] - x_m;
        shift_m[axis] = verb == "SHIFT" ? x_m : 0.0;
        step.resets[axis] = verb == "ORIGIN";
      }
    } else if (verb == "JUMP" || verb == "LINE") {
      std::array<double, 3> target_m = run.motion.position_m;
      for (int axis = 0; axis < 3; ++axis) {
        step.named[axis] = words.contains("XYZ"[axis]);
        if (step.named[axis]) target_m[axis] = value("XYZ"[axis]) * run.unit_m;
      }
      if (words.contains('F')) {
        run.set_feed(value('F'));
        step.feed_word = words.at('F');
      }
      step.plain = step.motion_word = true;
      run.motion_word = verb == "JUMP" ? 0 : 10;
      verb == "JUMP" ? run.rapid_to(target_m) : run.feed_to(target_m);
    } else if (verb != "STOP" && verb != "MARK" && !verb.empty()) {
      run.fail("'" + verb + "' is no word of Marker");
    }
    return verb == "STOP";
  }
};

/// The known controls and this one.
std::vector<NcControl> controls() {
  static const Marker language;
  std::vector<NcControl> all = nc_controls();
  all.push_back({.key = "marker", .title = "Marker", .about = "its own language", .languages = {&language}});
  return all;
}

NcProgram read(const std::string& text, const std::string& control = "marker") {
  NcSettings settings;
  settings.rapid_m_s = 0.25;  // 15 m/min
  settings.control = control;
  return read_nc_program(write_file("added_language_test.txt", text), settings, controls());
}

constexpr const char* kProgram =
    "MARK\r\nUNIT MM\r\nSPIN S600\r\nJUMP X0 Y0 Z5\r\nLINE  Z-1 F300 ! down\r\nLINE X100\r\nJUMP Z5\r\nSTOP\r\n";

TEST(AddedLanguage, IsRecognisedReadAndTimed) {
  const NcProgram program = read(kProgram);
  ASSERT_NE(program.language, nullptr);
  EXPECT_EQ(program.language->name(), "Marker");
  // 5 mm and 6 mm at 250 mm/s, 6 mm and 100 mm at 5 mm/s; sums of four terms in double precision
  EXPECT_NEAR(program.duration_s(), 5.0 / 250 + 6.0 / 5 + 100.0 / 5 + 6.0 / 250, 1e-12);
  EXPECT_DOUBLE_EQ(program.moves.back().speed_rpm, 600.0);
  EXPECT_EQ(nc_entries(program.steps, on_line(program, 6))[2], NcEntry::kStepInFeed);
  EXPECT_EQ(nc_entries(program.steps, on_line(program, 7))[2], NcEntry::kAlongRapid);
  EXPECT_EQ(read("G21\nG0 X0\nM2\n", "linuxcnc").language->name(), "LinuxCNC");
}

TEST(AddedLanguage, RefusesProgramsOfOthersAndControlsThatNobodyKnows) {
  EXPECT_REFUSED(read("G21\nG0 X0\nM2\n"), "the program is in no language of Marker");
  EXPECT_THAT([] { (void)read(kProgram, "plotter"); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("'plotter'"), HasSubstr("siemens, heidenhain and marker"))));
}

TEST(AddedLanguage, GetsCorrectionsInItsOwnWords) {
  const NcProgram program = read(kProgram);
  const NcOffsetOptions options{.language = program.language, .axes = {false, false, true}, .remarks = {"at most 20 um"}};
  const std::vector<NcOffsetChange> changes = {{on_line(program, 6), 0.5, {{std::nullopt, std::nullopt, 12.5e-6}}}};
  const CorrectedNcProgram corrected = corrected_nc_program(kProgram, program.steps, {0, 0, -5e-6}, changes, options);
  EXPECT_EQ(corrected.text,
            "MARK\r\nUNIT MM\r\nSPIN S600\r\n! corrections by SHIFT\r\n! driftwright: at most 20 um\r\nSHIFT Z-0.005\r\n"
            "JUMP X0 Y0 Z5\r\nLINE  Z-1 F300 ! down\r\nLINE X50\r\nSHIFT Z0.0125\r\nLINE Z-1\r\nLINE X100\r\nJUMP Z5\r\n"
            "SHIFT Z0\r\nSTOP\r\n");
  EXPECT_THAT(corrected.lines, ::testing::ElementsAre(10));
  // Read again: the first rapid is 5 um shorter, and a step of 17.5 um at 5 mm/s is added; the tool ends where the last
  // correction has put it.
  const NcProgram again = read(corrected.text);
  EXPECT_NEAR(again.duration_s(), program.duration_s() - 5e-3 / 250 + 17.5e-3 / 5, 1e-12);
  EXPECT_NEAR(again.steps.back().end_m[2], 5.0125e-3, 1e-12);
}

TEST(AddedLanguage, HasItsOwnNumbersAndEndsOfBlocks) {
  const std::string text = ":1 MARK .\n:2 UNIT MM .\n:3 JUMP X0 Z5 .\n:4 LINE Z0 F300 .\n:7 JUMP Z5 .\n:8 STOP .\n";
  const NcProgram program = read(text);
  const NcOffsetOptions options{.language = program.language, .axes = {true, false, false}};
  EXPECT_EQ(corrected_nc_program(text, program.steps, {1e-5, 0, 0}, {}, options).text,
            ":1 MARK .\n:2 UNIT MM .\n:3 ! corrections by SHIFT .\n:4 SHIFT X0.01 .\n:5 JUMP X0 Z5 .\n:6 LINE Z0 F300 .\n"
            ":7 JUMP Z5 .\n:8 SHIFT X0 .\n:9 STOP .\n");
}

// A word of the program takes corrections away; after it they are set again. In one block with a motion it is refused.
TEST(AddedLanguage, SetsCorrectionsAgainAfterTheProgramTakesThemAway) {
  const std::string text = "MARK\nUNIT MM\nJUMP X0 Z5\nORIGIN X3\nJUMP X1\nSTOP\n";
  const NcProgram program = read(text);
  const NcOffsetOptions options{.language = program.language, .axes = {true, false, false}};
  EXPECT_THAT(corrected_nc_program(text, program.steps, {1e-5, 0, 0}, {}, options).text,
              HasSubstr("JUMP X0 Z5\nORIGIN X3\nSHIFT X0.01\nJUMP X1\nSHIFT X0\nSTOP\n"));
  std::vector<NcStep> steps = program.steps;
  steps[on_line(program, 5)].resets = {true, false, false};
  EXPECT_THAT(
      [&] {
        (void)corrected_nc_program(text, steps, {1e-5, 0, 0}, {}, options);
      },
      ThrowsMessage<InputError>(AllOf(HasSubstr(":5:"), HasSubstr("in a block of its own"))));
}

TEST(AddedLanguage, NamesItsOwnUnit) {
  const auto correct = [](const std::string& text) {
    const NcProgram program = read(text);
    (void)corrected_nc_program(text, program.steps, {1e-5, 0, 0}, {},
                               {.language = program.language, .axes = {true, false, false}});
  };
  EXPECT_REFUSED(correct("MARK\nJUMP X0\nSTOP\n"), "write UNIT MM in a block");
  EXPECT_REFUSED(correct("MARK\nUNIT INCH\nJUMP X0\nSTOP\n"), "the program is in inches");
}

}  // namespace
}  // namespace driftwright::added_language_test
