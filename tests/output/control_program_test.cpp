// Programs for controls are read back by a small reader of each language, run row by row, and compared with the judged
// correction.

#include "output/control_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <regex>
#include <sstream>

#include "base/errors.hpp"
#include "tests/shared/deployed_model.hpp"

namespace driftwright::output::control_program_test {
namespace {

using fixtures::deployed;
using fixtures::machine;
using fixtures::warm_machine;
using ::testing::HasSubstr;

using Memory = std::map<std::string, double>;

/// Sums and products of numbers and variables, with parentheses.
class Expression {
 public:
  Expression(std::string text, Memory& memory) : text_(std::move(text)), memory_(memory) {}
  double value() {
    const double v = sum();
    blanks();
    EXPECT_EQ(at_, text_.size()) << text_;
    return v;
  }

 private:
  void blanks() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  bool takes(char ch) {
    blanks();
    if (at_ >= text_.size() || text_[at_] != ch) return false;
    ++at_;
    return true;
  }
  double sum() {
    double v = product();
    for (;;) {
      if (takes('+')) {
        v += product();
      } else if (takes('-')) {
        v -= product();
      } else {
        return v;
      }
    }
  }
  double product() {
    double v = factor();
    for (;;) {
      if (takes('*')) {
        v *= factor();
      } else if (takes('/')) {
        v /= factor();
      } else {
        return v;
      }
    }
  }
  double factor() {
    if (takes('+')) return factor();
    if (takes('-')) return -factor();
    if (takes('(')) {
      const double v = sum();
      EXPECT_TRUE(takes(')')) << text_;
      return v;
    }
    blanks();
    static const std::regex number("[0-9]+\\.?[0-9]*"), variable("[$#A-Za-z_][$A-Za-z0-9_]*(\\[[A-Z0-9]+\\])?");
    std::smatch found;
    const std::string rest = text_.substr(at_);
    if (std::regex_search(rest, found, number, std::regex_constants::match_continuous)) {
      at_ += found.length();
      return std::stod(found.str());
    }
    EXPECT_TRUE(std::regex_search(rest, found, variable, std::regex_constants::match_continuous)) << text_;
    at_ += std::max<std::size_t>(1, static_cast<std::size_t>(found.length()));
    EXPECT_TRUE(memory_.contains(found.str())) << found.str() << " is read before it is set";
    return memory_[found.str()];
  }

  std::string text_;
  Memory& memory_;
  std::size_t at_ = 0;
};

double value_of(const std::string& text, Memory& memory) {
  return Expression(text, memory).value();
}

bool compares(const std::string& a, const std::string& sign, const std::string& b, Memory& memory) {
  const double x = value_of(a, memory), y = value_of(b, memory);
  if (sign == "<" || sign == "LT") return x < y;
  if (sign == ">" || sign == "GT") return x > y;
  if (sign == "NE") return x != y;
  EXPECT_TRUE(sign == "=" || sign == "==" || sign == "EQ") << sign;
  return x == y;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// A program in its control: readings in, correction [um] out.
class Control {
 public:
  virtual ~Control() = default;
  virtual double row(const std::vector<double>& readings) = 0;
};

class StructuredTextControl final : public Control {
 public:
  explicit StructuredTextControl(const std::string& text) {
    static const std::regex variable("  (\\w+) : LREAL;.*");
    bool is_input = false, is_body = false;
    std::smatch m;
    for (const std::string& line : lines_of(text)) {
      if (line == "VAR_INPUT") is_input = true;
      if (line == "VAR" || line == "VAR_OUTPUT") is_input = false;
      if (std::regex_match(line, m, variable)) {
        memory_[m[1].str()] = 0.0;  // the standard's initial value
        if (is_input) inputs_.push_back(m[1].str());
        is_body = true;
      } else if (is_body && line != "END_VAR" && line != "VAR" && line != "VAR_OUTPUT" && line != "END_FUNCTION_BLOCK") {
        body_.push_back(line);
      }
    }
  }
  double row(const std::vector<double>& readings) override {
    static const std::regex always("(\\w+) := (.*);"), sometimes("IF (\\S+) (<|=|>) (.*) THEN (\\w+) := (.*); END_IF;");
    EXPECT_EQ(inputs_.size(), readings.size());
    for (std::size_t k = 0; k < readings.size(); ++k) memory_[inputs_[k]] = readings[k];
    std::smatch m;
    for (const std::string& line : body_) {
      if (std::regex_match(line, m, sometimes)) {
        if (compares(m[1], m[2], m[3], memory_)) memory_[m[4].str()] = value_of(m[5], memory_);
      } else if (std::regex_match(line, m, always)) {
        memory_[m[1].str()] = value_of(m[2], memory_);
      } else {
        ADD_FAILURE() << line;
      }
    }
    return memory_["correction_um"];
  }

 private:
  Memory memory_;
  std::vector<std::string> inputs_, body_;
};

/// A program over the travel: the position is the last input.
double at_position(StructuredTextControl& control, std::vector<double> readings, double position_mm) {
  readings.push_back(position_mm);
  return control.row(readings);
}

/// Synchronized actions in the order of their numbers, in each of several interpolation cycles a row.
class SiemensControl final : public Control {
 public:
  SiemensControl(const std::string& text, double period_s, bool against_dk)
      : cycle_s_(period_s / 4.0), sign_(against_dk ? 1e3 : -1e3) {
    static const std::regex assigned("(\\$[A-Z_]+\\[\\d+\\])=(.*)"), action("IDS=(\\d+) (.*)");
    std::smatch m;
    for (const std::string& line : lines_of(text)) {
      if (std::regex_match(line, m, action)) {
        EXPECT_EQ(std::stoul(m[1]), actions_.size() + 1);
        actions_.push_back(read(m[2].str()));
      } else if (std::regex_match(line, m, assigned)) {
        EXPECT_TRUE(actions_.empty());
        memory_[m[1].str()] = value_of(m[2], memory_);
      } else {
        EXPECT_TRUE(line.starts_with("PROC ") || line.starts_with(";") || line == "RET" || line == "METRIC:" ||
                    line.starts_with("SETAL(65024)") || line == "IF $MN_SCALING_SYSTEM_IS_METRIC==TRUE GOTOF METRIC")
            << line;
      }
    }
  }
  double row(const std::vector<double>& readings) override {
    for (std::size_t k = 0; k < readings.size(); ++k) memory_[fmt::format("$A_DBR[{}]", 4 * k)] = readings[k];
    for (int cycle = 0; cycle < 4; ++cycle) {
      for (const Action& a : actions_) act(a);
      memory_["$AC_TIMER[0]"] += cycle_s_;
    }
    return sign_ * memory_["$$SA_TEMP_COMP_ABS_VALUE[Z]"];
  }
  /// Where the axis is during the next rows.
  void go_to(double position_mm) { memory_["$AA_IM[Z]"] = position_mm; }
  /// What the control compensates there: K0 + tan beta (P - P0).
  double compensated_um() {
    return sign_ * (memory_["$$SA_TEMP_COMP_ABS_VALUE[Z]"] +
                    memory_["$$SA_TEMP_COMP_SLOPE[Z]"] * (memory_["$AA_IM[Z]"] - memory_["$$SA_TEMP_COMP_REF_POSITION[Z]"]));
  }

 private:
  struct Relation {
    std::string a, sign, b;
  };
  struct Action {
    std::vector<Relation> conditions;
    std::vector<std::pair<std::string, std::string>> assignments;  ///< all in one cycle
  };

  static Action read(const std::string& text) {
    static const std::regex whole("(WHENEVER (.*) )?DO (.*)"), two("\\((.*?)\\) AND \\((.*)\\)"),
        relation("(\\$[A-Z_]+\\[[A-Z0-9]+\\])(==|>=|<|>)(.*)"),
        assigned("(\\$\\$?[A-Z_]+\\[[A-Z0-9]+\\])=(.*?)(?= \\$\\$[A-Z_]+\\[[A-Z]\\]=|$)");
    std::smatch m, r;
    EXPECT_TRUE(std::regex_match(text, m, whole)) << text;
    Action action;
    const std::string all = m[3];
    for (std::sregex_iterator a(all.begin(), all.end(), assigned), end; a != end; ++a)
      action.assignments.emplace_back((*a)[1], (*a)[2]);
    EXPECT_FALSE(action.assignments.empty()) << text;
    const std::string condition = m[2];
    std::vector<std::string> conditions;
    if (std::regex_match(condition, r, two)) {
      conditions = {r[1], r[2]};
    } else if (!condition.empty()) {
      conditions = {condition};
    }
    for (const std::string& c : conditions) {
      EXPECT_TRUE(std::regex_match(c, r, relation)) << text;
      action.conditions.push_back({r[1], r[2], r[3]});
    }
    return action;
  }
  void act(const Action& action) {
    for (const Relation& c : action.conditions) {
      const bool is_true =
          c.sign == ">=" ? value_of(c.a, memory_) >= value_of(c.b, memory_) : compares(c.a, c.sign, c.b, memory_);
      if (!is_true) return;
    }
    for (const auto& [target, value] : action.assignments) memory_[target] = value_of(value, memory_);
  }

  Memory memory_;
  std::vector<Action> actions_;
  double cycle_s_, sign_;
};

class FanucControl final : public Control {
 public:
  explicit FanucControl(const std::string& text) : lines_(lines_of(text)) {
    memory_["#0"] = 0.0;
    memory_["#4006"] = 21.0;
    memory_["#4003"] = 90.0;
    for (int k = 501; k < 1000; ++k) memory_[fmt::format("#{}", k)] = 0.0;
  }
  double row(const std::vector<double>& readings) override {
    static const std::regex always("(#\\d+)=(.*)"), sometimes("IF \\((\\S+) (LT|EQ|GT) (.*)\\) THEN (#\\d+)=(.*)"),
        shift("G10 L2 P0 Z\\((.*)\\)");
    for (std::size_t k = 0; k < readings.size(); ++k) memory_[fmt::format("#{}", 501 + k)] = readings[k];
    std::smatch m;
    double z_mm = NAN;
    for (std::string line : lines_) {
      if (line.starts_with("(") || line.starts_with("O") || line == "%" || line == "M99") continue;
      for (char& ch : line) ch = ch == '[' ? '(' : ch == ']' ? ')' : ch;
      if (std::regex_match(line, m, sometimes)) {
        if (compares(m[1], m[2], m[3], memory_)) memory_[m[4].str()] = value_of(m[5], memory_);
      } else if (std::regex_match(line, m, always)) {
        memory_[m[1].str()] = value_of(m[2], memory_);
      } else if (std::regex_match(line, m, shift)) {
        z_mm = value_of(m[1], memory_);
      } else {
        ADD_FAILURE() << line;
      }
    }
    return -1e3 * z_mm;
  }

 private:
  Memory memory_;
  std::vector<std::string> lines_;
};

class HeidenhainControl final : public Control {
 public:
  explicit HeidenhainControl(const std::string& text) {
    std::size_t n = 0;
    for (const std::string& line : lines_of(text)) {
      const std::string number = fmt::format("{} ", n++);
      EXPECT_TRUE(line.starts_with(number)) << line;
      blocks_.push_back(line.substr(number.size()));
    }
    for (int k = 0; k < 500; ++k) memory_[fmt::format("QR{}", k)] = 0.0;
  }
  double row(const std::vector<double>& readings) override {
    static const std::regex always("(Q[LR]\\d+) = (.*)"), jump("FN (10|11|12): IF (\\S+) (NE|GT|LT) (\\S+) GOTO LBL (\\d+)"),
        shift("CYCL DEF 7\\.1 Z(.*)");
    for (std::size_t k = 0; k < readings.size(); ++k) memory_[fmt::format("Q{}", 100 + k)] = readings[k];
    std::smatch m;
    double z_mm = NAN;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const std::string& block = blocks_[b];
      if (block.starts_with(";") || block.starts_with("LBL ") || block.starts_with("BEGIN PGM") ||
          block.starts_with("END PGM") || block == "CYCL DEF 7.0 DATUM SHIFT")
        continue;
      if (std::regex_match(block, m, jump)) {
        EXPECT_EQ(m[1] == "10", m[3] == "NE");
        EXPECT_EQ(m[1] == "11", m[3] == "GT");
        if (compares(m[2], m[3], m[4], memory_))
          b = static_cast<std::size_t>(std::find(blocks_.begin(), blocks_.end(), "LBL " + m[5].str()) - blocks_.begin());
        EXPECT_LT(b, blocks_.size());
      } else if (std::regex_match(block, m, always)) {
        memory_[m[1].str()] = value_of(m[2], memory_);
      } else if (std::regex_match(block, m, shift)) {
        z_mm = value_of(m[1], memory_);
      } else {
        ADD_FAILURE() << block;
      }
    }
    return -1e3 * z_mm;
  }

 private:
  Memory memory_;
  std::vector<std::string> blocks_;
};

/// The guards of the fixture without relations and jumps, so that no reading is doubted, and the judged correction.
DeployedModel undoubted(bool from_start, double period_s) {
  DeployedModel d = deployed(from_start, period_s);
  for (auto& g : d.safe.guards) {
    g.others_coefficient.clear();
    g.most_jump = HUGE_VAL;
  }
  return d;
}

/// Without what a program that knows no time cannot hold.
DeployedModel without_time(DeployedModel d) {
  std::erase_if(d.model.terms, [](const auto& t) { return t.lag_s > 0.0 || t.unit == "rpm"; });
  std::erase_if(d.safe.guards, [](const auto& g) { return g.unit == "rpm"; });
  d.safe = compensation::with_known_start(std::move(d.safe));
  return d;
}

/// Readings that leave their ranges for a while: trust falls, and the correction is slewed.
Record troubled(double period_s) {
  Record r = machine(5, period_s);
  for (std::size_t i = 150; i < 220; ++i) r.channels[0].values[i] += 0.25 * static_cast<double>(i - 150);
  return r;
}

void expect_judged(const DeployedModel& d, const ControlProgram& program, Control& control, bool knows_time) {
  const Record record = troubled(d.safe.period_s);
  const compensation::Repaired r = compensation::repaired(d.safe, record);
  ASSERT_TRUE(r.events.empty());
  const std::vector<double> predicted = d.model.predict(r.readings);
  const compensation::GuardedCorrection judged = compensation::guarded(d.safe, r, predicted);
  double least_trust = 1.0, most_um = 0.0;
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    std::vector<double> readings;
    for (const auto& g : d.safe.guards) readings.push_back(record.at(g.input).values[i]);
    const double expected =
        knows_time ? judged.correction_um[i] : std::clamp(r.deserved[i] * predicted[i], d.safe.lowest_um, d.safe.highest_um);
    ASSERT_NEAR(control.row(readings), expected, program.error_um) << "row " << i;
    least_trust = std::min(least_trust, r.deserved[i]);
    most_um = std::max(most_um, std::abs(expected));
  }
  EXPECT_LT(least_trust, 0.9);
  EXPECT_GT(most_um, 1.0);
}

/// A machine that has just worked: trust is lost at the start, and comes back if the drift does not count from it.
void expect_warm_start_as_judged(const DeployedModel& d, const ControlProgram& program, Control& control) {
  const Record record = warm_machine(5, d.safe.period_s);
  const compensation::Repaired r = compensation::repaired(d.safe, record);
  EXPECT_THAT(r.events, ::testing::ElementsAre(compensation::kStrangeStart));
  EXPECT_EQ(r.deserved.front(), 0.0);
  EXPECT_EQ(r.deserved.back() > 0.5, !d.safe.from_start);
  const compensation::GuardedCorrection judged = compensation::guarded(d.safe, r, d.model.predict(r.readings));
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    std::vector<double> readings;
    for (const auto& g : d.safe.guards) readings.push_back(record.at(g.input).values[i]);
    ASSERT_NEAR(control.row(readings), judged.correction_um[i], program.error_um) << "row " << i;
  }
}

class InCycle : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(FromStartOrNot, InCycle, ::testing::Bool());

TEST_P(InCycle, StructuredTextGivesTheJudgedCorrection) {
  const DeployedModel d = undoubted(GetParam(), 7.3);
  const ControlProgram p = control_program(d, ControlLanguage::kStructuredText, "2nd, best", {}, "a test");
  EXPECT_EQ(p.file, "X_2nd_best.st");
  EXPECT_EQ(p.error_um, 1e-9);
  StructuredTextControl control(p.text), of_warm_machine(p.text);
  expect_judged(d, p, control, true);
  expect_warm_start_as_judged(d, p, of_warm_machine);
}

TEST_P(InCycle, SynchronizedActionsOfSiemensGiveTheJudgedCorrection) {
  for (bool against_dk : {false, true}) {
    const DeployedModel d = undoubted(GetParam(), 8.0);
    const ControlProgram p = control_program(d, ControlLanguage::kSiemens, "ridge", {'Z', against_dk}, "a test");
    EXPECT_EQ(p.file, "RIDGE.SPF");
    EXPECT_EQ(p.error_um, 1e-9);
    SiemensControl control(p.text, 8.0, against_dk), of_warm_machine(p.text, 8.0, against_dk);
    expect_judged(d, p, control, true);
    expect_warm_start_as_judged(d, p, of_warm_machine);
  }
}

TEST_P(InCycle, ProgramsThatAreCalledGiveWhatNeedsNoTime) {
  const DeployedModel d = without_time(undoubted(GetParam(), 60.0));
  const ControlProgram heidenhain = control_program(d, ControlLanguage::kHeidenhain, "ridge", {}, "a test");
  HeidenhainControl tnc(heidenhain.text);
  EXPECT_LT(heidenhain.error_um, 1e-6);
  expect_judged(d, heidenhain, tnc, false);
  const ControlProgram fanuc = control_program(d, ControlLanguage::kFanuc, "ridge", {}, "a test");
  FanucControl control(fanuc.text);
  EXPECT_LT(fanuc.error_um, 1e-3);
  expect_judged(d, fanuc, control, false);
}

// Millimetres in a control that is in inches are 25 times as much.
TEST(ControlProgram, RefusesInchesBeforeItSetsAnOffset) {
  const DeployedModel d = without_time(undoubted(false, 60.0));
  const auto comes_before = [](const std::string& text, const std::string& check, const std::string& what) {
    EXPECT_LT(text.find(check), text.find(what)) << text;
    EXPECT_NE(text.find(what), std::string::npos) << text;
  };
  const std::string fanuc = control_program(d, ControlLanguage::kFanuc, "ridge", {}, "a test").text,
                    siemens = control_program(d, ControlLanguage::kSiemens, "ridge", {'Z', false}, "a test").text;
  comes_before(fanuc, "IF [#4006 LT 21] THEN #3000=1 (", "G10 L2 P0 Z");
  comes_before(fanuc, "IF [#4003 GT 90] THEN #3000=2 (", "G10 L2 P0 Z");
  comes_before(siemens, "IF $MN_SCALING_SYSTEM_IS_METRIC==TRUE GOTOF METRIC\nSETAL(65024)", "IDS=1 ");
}

std::string refusal(const std::function<void()>& what) {
  try {
    what();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST_P(InCycle, ConstantsOfFanucHaveEightDigitsWithTheZeroBeforeThePoint) {
  DeployedModel d = without_time(undoubted(GetParam(), 60.0));
  for (auto& term : d.model.terms) term.coefficient = 0.123456789123 * (term.coefficient < 0.0 ? -1.0 : 1.0);
  d.model.intercept = 0.012345678912;
  const ControlProgram p = control_program(d, ControlLanguage::kFanuc, "ridge", {}, "a test");
  EXPECT_THAT(p.text, HasSubstr("0.1234568"));
  for (const std::string& line : lines_of(p.text)) {
    if (line.starts_with("(")) continue;
    static const std::regex number("[0-9]+\\.[0-9]+");
    for (std::sregex_iterator n(line.begin(), line.end(), number), end; n != end; ++n)
      EXPECT_LE(n->str().size(), 9u) << "eight digits and a point: " << line;
  }
  EXPECT_LT(p.error_um, 1e-3);
  FanucControl control(p.text);
  expect_judged(d, p, control, false);
  d.model.intercept = 2e7;
  EXPECT_THROW((void)control_program(d, ControlLanguage::kFanuc, "ridge", {}, "a test"), InputError);
}

/// Formulas for three places: the fixture's at -100 mm, half of it at 300 mm, without one of its thermometers if they do not
/// read alike, and twice as much at 500 mm.
std::vector<PlacedModel> three_places(bool from_start, double period_s, bool read_alike = false) {
  std::vector<PlacedModel> places;
  for (const double at_mm : {-100.0, 300.0, 500.0}) {
    DeployedModel d = undoubted(from_start, period_s);
    const double factor = at_mm < 0.0 ? 1.0 : at_mm < 400.0 ? 0.5 : 2.0;
    d.model.target = fmt::format("x_{:.0f}", at_mm);
    d.model.intercept *= factor;
    for (auto& term : d.model.terms) term.coefficient *= factor;
    if (at_mm == 300.0 && !read_alike) {
      std::erase_if(d.model.terms, [](const auto& t) { return t.input == "X1"; });
      std::erase_if(d.safe.guards, [](const auto& g) { return g.input == "X1"; });
      d.safe = compensation::with_known_start(std::move(d.safe));  // weights are of all thermometers together
    }
    places.push_back({std::move(d), at_mm});
  }
  return places;
}

/// The judged corrections of the places in the rows of a run.
std::vector<std::vector<double>> judged_of(const std::vector<PlacedModel>& places, const Record& record) {
  std::vector<std::vector<double>> all;
  for (const PlacedModel& p : places) {
    const compensation::Repaired r = compensation::repaired(p.model.safe, record);
    all.push_back(compensation::guarded(p.model.safe, r, p.model.model.predict(r.readings)).correction_um);
  }
  return all;
}

/// Straight between the places, held beyond them.
double straight(const std::vector<PlacedModel>& places, const std::vector<std::vector<double>>& um, std::size_t row,
                double mm) {
  if (mm <= places[0].at_mm) return um[0][row];
  for (std::size_t k = 1; k < places.size(); ++k) {
    const double share = (mm - places[k - 1].at_mm) / (places[k].at_mm - places[k - 1].at_mm);
    if (share <= 1.0) return (1.0 - share) * um[k - 1][row] + share * um[k][row];
  }
  return um.back()[row];
}

// Wherever the axis is: beyond the ends, at places and between them.
TEST_P(InCycle, OverTheTravelTheCorrectionsOfPlacesAreStraightBetweenThem) {
  const std::vector<PlacedModel> places = three_places(GetParam(), 8.0);
  const Record record = troubled(8.0);
  const std::vector<std::vector<double>> um = judged_of(places, record);
  const ControlProgram st = control_program_over_travel(places, ControlLanguage::kStructuredText, "screw", {}, "a test");
  StructuredTextControl block(st.text);
  EXPECT_EQ(st.error_um, 1e-9);
  double most_um = 0.0;
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    std::vector<double> readings;
    for (const auto& g : places.front().model.safe.guards) readings.push_back(record.at(g.input).values[i]);
    const double mm = -250.0 + 900.0 * std::fmod(0.37 * static_cast<double>(i), 1.0);
    ASSERT_NEAR(at_position(block, readings, mm), straight(places, um, i, mm), 1e-9) << i << " " << mm;
    most_um = std::max(most_um, std::abs(um[2][i] - um[0][i]));
  }
  EXPECT_GT(most_um, 5.0);
}

// Readings that all places have are looked at once, else there were too many actions.
TEST_P(InCycle, OverTheTravelSiemensHasTheStraightPieceInWhichTheAxisIs) {
  const std::vector<PlacedModel> places = three_places(GetParam(), 8.0, true);
  const Record record = troubled(8.0);
  const std::vector<std::vector<double>> um = judged_of(places, record);
  const bool against_dk = GetParam();
  const ControlProgram p =
      control_program_over_travel(places, ControlLanguage::kSiemens, "screw", {'Z', against_dk}, "a test");
  EXPECT_THAT(p.text, HasSubstr("MD32750 = 3"));
  SiemensControl control(p.text, 8.0, against_dk);
  const std::vector<double> all_mm = {-200.0, -100.0, 0.0, 299.0, 300.0, 450.0, 500.0, 700.0};
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    std::vector<double> readings;
    for (const auto& g : places.front().model.safe.guards) readings.push_back(record.at(g.input).values[i]);
    const double mm = all_mm[i % all_mm.size()];
    control.go_to(mm);
    (void)control.row(readings);
    ASSERT_NEAR(control.compensated_um(), straight(places, um, i, mm), 1e-9) << i << " " << mm;
  }
}

TEST(ControlProgram, OverTheTravelIsRefusedWhereAControlKnowsNoPositionAndForPlacesOfTwoStudies) {
  std::vector<PlacedModel> places = three_places(true, 60.0);
  for (ControlLanguage language : {ControlLanguage::kHeidenhain, ControlLanguage::kFanuc})
    EXPECT_THAT(refusal([&] { (void)control_program_over_travel(places, language, "screw", {}, "a test"); }),
                HasSubstr("one shift for the whole travel"));
  places[1].model.safe.period_s = 30.0;
  EXPECT_THAT(refusal([&] { (void)control_program_over_travel(places, ControlLanguage::kSiemens, "screw", {}, "a test"); }),
              HasSubstr("60 s and 30 s apart"));
}

TEST(ControlProgram, IsRefusedWhereTheLanguageCannotHoldTheFormula) {
  const DeployedModel d = undoubted(true, 60.0);
  for (ControlLanguage language : {ControlLanguage::kHeidenhain, ControlLanguage::kFanuc}) {
    const std::string said = refusal([&] { (void)control_program(d, language, "ridge", {}, "a test"); });
    EXPECT_THAT(said, HasSubstr("a lag of 'X1'"));
    EXPECT_THAT(said, HasSubstr("--as st"));
  }
  DeployedModel many = without_time(d);
  for (int k = 0; k < 6; ++k) many.safe.guards.push_back(many.safe.guards.front());
  EXPECT_THAT(refusal([&] { (void)control_program(many, ControlLanguage::kHeidenhain, "ridge", {}, "a test"); }),
              HasSubstr("Q100 to Q107"));
  DeployedModel long_one = d;
  for (int k = 0; k < 60; ++k) long_one.model.terms.push_back(d.model.terms[2]);
  EXPECT_THAT(refusal([&] { (void)control_program(long_one, ControlLanguage::kSiemens, "ridge", {}, "a test"); }),
              HasSubstr("synchronized actions"));
}

}  // namespace
}  // namespace driftwright::output::control_program_test
