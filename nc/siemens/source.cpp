#include "nc/siemens/source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "nc/expression.hpp"
#include "nc/operators.hpp"

namespace driftwright {
namespace {

/// ( ), names and R1 as variables, DIV MOD == <> < > <= >= AND OR NOT, SIN( ) in degrees, ATAN2( , ).
/// Source: Siemens, SINUMERIK 840D sl / 828D, Programming Manual Job Planning, arithmetic functions and comparisons.
const NcSyntax& siemens_syntax() {
  static const NcSyntax syntax = {
      .operators = {{"*", 5, op::product},
                    {"/", 5, op::quotient},
                    {"DIV", 5, op::whole_quotient},
                    {"MOD", 5, op::modulus},
                    {"+", 4, op::plus},
                    {"-", 4, op::minus},
                    {"==", 3, op::same},
                    {"<>", 3, op::different},
                    {"<=", 3, op::at_most},
                    {">=", 3, op::at_least},
                    {"<", 3, op::less},
                    {">", 3, op::greater},
                    {"AND", 2, op::both},
                    {"XOR", 1, op::one_of},
                    {"OR", 1, op::either}},
      .functions = {{"TRUNC", [](double x) { return std::trunc(x); }}, {"POT", [](double x) { return x * x; }}},
      .constants = {{"TRUE", 1.0}, {"FALSE", 0.0}},
      .negation = "NOT",
      .angle_of_two = "ATAN2",
      .has_named_variables = true};
  return syntax;
}

struct Repetition {
  std::size_t first = 0, last = 0;  ///< lines, both included
  int left = 0;
  std::size_t back = 0;  ///< line at which it continues
};

}  // namespace

class SiemensSource::Impl {
 public:
  Impl(const std::string& path, const std::vector<std::string>& text, NcExecution& run)
      : run_(run), lines_(siemens_lines(path, text)) {}

  const SiemensLine* next() {
    end_repetitions();  // the block before it may have been their last
    while (at_ < lines_.size()) {
      const SiemensLine& line = lines_[at_];
      run_.count(line.where);
      if (!statement(line)) {
        ++at_;
        return &line;
      }
      end_repetitions();
    }
    return nullptr;
  }

  double value_of(const SiemensLine& line, const std::string& text, std::size_t column, bool alone) const {
    std::size_t at = 0;
    try {
      const double x = evaluate(text, at, siemens_syntax(), lookup(), true).value;
      if (alone && text.find_first_not_of(" \t", at) != std::string::npos)
        throw RangeError("the expression has more text after its end");
      return x;
    } catch (const RangeError& e) {
      fail_at(line, column + at, e.what());
    }
  }

  bool is_variable(const std::string& name) const { return is_r_parameter(name) || variables_.contains(name); }
  void set_variable(const std::string& name, double value) { variables_[name] = value; }

 private:
  NcLookup lookup() const {
    return [this](const std::string& name) -> NcValue {
      const auto found = variables_.find(name);
      if (found != variables_.end()) return {found->second};
      if (is_r_parameter(name))
        throw RangeError(
            fmt::format("{} is what the operator or another program has set; give it a value in the program first", name));
      throw RangeError(fmt::format("'{}' is known only at the machine or not at all", name));
    };
  }

  double value(const SiemensLine& line, const std::string& text, std::size_t& at) const {
    try {
      return evaluate(text, at, siemens_syntax(), lookup(), true).value;
    } catch (const RangeError& e) {
      fail_at(line, at, e.what());
    }
  }

  std::size_t place_of(const SiemensLine& line, const std::string& label, std::size_t column, int direction) const {
    const auto is_it = [&](const SiemensLine& l) { return l.label == label || (!l.number.empty() && l.number == label); };
    if (direction >= 0) {
      for (std::size_t i = at_ + 1; i < lines_.size(); ++i)
        if (is_it(lines_[i])) return i;
    }
    if (direction <= 0) {
      for (std::size_t i = 0; i <= at_; ++i)
        if (is_it(lines_[i])) return i;
    }
    fail_at(line, column,
            fmt::format("no label {} {}", label,
                        direction > 0   ? "further on"
                        : direction < 0 ? "before"
                                        : "in the program"));
  }

  /// Executes "GOTOF LABEL" at text[from]. @returns true  if there is one
  bool jump(const SiemensLine& line, std::size_t from) {
    const std::string& text = line.text;
    std::size_t i = from;
    const std::string word = siemens_name(text, i);
    if (word != "GOTOF" && word != "GOTOB" && word != "GOTO" && word != "GOTOC" && word != "GOTOS") return false;
    if (word == "GOTOS") {
      at_ = 0;
      return true;
    }
    while (i < text.size() && text[i] == ' ') ++i;
    const std::size_t column = i;
    std::string label;
    while (i < text.size() && text[i] != ' ')
      label += static_cast<char>(std::toupper(static_cast<unsigned char>(text[i++])));
    if (label.starts_with(':')) label[0] = 'N';
    at_ = place_of(line, label, column, word == "GOTOF" ? 1 : word == "GOTOB" ? -1 : 0);
    return true;
  }

  void condition(const SiemensLine& line, std::size_t i, bool goes_on_if) {
    if ((value(line, line.text, i) != 0.0) == goes_on_if) {
      ++at_;
    } else {
      at_ = line.partner + 1;
    }
  }

  /// Executes a line that controls the order of execution. @returns true  if it is one
  bool statement(const SiemensLine& line) {
    std::size_t i = line.begin;
    const std::string word = siemens_name(line.text, i);
    if (word == "DEF") return define(line, i);
    if (word.starts_with("GOTO")) return jump(line, line.begin);
    if (word == "CASE") fail_at(line, line.begin, "CASE is not followed here; write IF and GOTOF");
    if (word == "PROC" || word == "EXTERN")
      fail_at(line, line.begin, "subprograms are not called here; let the post-processor write them out");
    if (word == "IF") {
      const bool met = value(line, line.text, i) != 0.0;
      while (i < line.text.size() && line.text[i] == ' ') ++i;
      if (i >= line.text.size()) {
        at_ = met ? at_ + 1 : line.partner + 1;
      } else if (!met) {
        std::size_t behind = i;
        if (!siemens_name(line.text, behind).starts_with("GOTO"))
          fail_at(line, i, "GOTOF, GOTOB or GOTO is expected after IF");
        ++at_;
      } else if (!jump(line, i)) {
        fail_at(line, i, "GOTOF, GOTOB or GOTO is expected after IF");
      }
      return true;
    }
    if (word == "ELSE") {
      at_ = line.partner + 1;
    } else if (word == "ENDIF" || word == "LOOP" || (word == "REPEAT" && line.partner > 0)) {
      ++at_;
    } else if (word == "WHILE") {
      condition(line, i, true);
    } else if (word == "ENDWHILE" || word == "ENDLOOP") {
      at_ = line.partner;
    } else if (word == "UNTIL") {
      at_ = value(line, line.text, i) != 0.0 ? at_ + 1 : line.partner;
    } else if (word == "FOR") {
      begin_for(line, i);
    } else if (word == "ENDFOR") {
      next_for(lines_[line.partner]);
    } else if (word == "REPEAT" || word == "REPEATB") {
      repeat(line, i, word == "REPEATB");
    } else {
      return false;
    }
    return true;
  }

  bool define(const SiemensLine& line, std::size_t i) {
    const std::string type = siemens_name(line.text, i);
    if (type != "REAL" && type != "INT" && type != "BOOL")
      fail_at(line, line.begin, "of variables only REAL, INT and BOOL are followed here");
    while (true) {
      const std::string name = siemens_name(line.text, i);
      if (name.empty()) fail_at(line, i, "a name is expected here");
      double initial = 0.0;
      while (i < line.text.size() && line.text[i] == ' ') ++i;
      if (i < line.text.size() && line.text[i] == '=') initial = value(line, line.text, ++i);
      variables_[name] = initial;
      while (i < line.text.size() && line.text[i] == ' ') ++i;
      if (i >= line.text.size()) break;
      if (line.text[i++] != ',') fail_at(line, i - 1, "',' or the end of the line is expected here");
    }
    ++at_;
    return true;
  }

  struct For {
    std::string name;
    double from = 0.0, to = 0.0;
  };
  For for_of(const SiemensLine& line, std::size_t i) {
    For loop;
    loop.name = siemens_name(line.text, i);
    while (i < line.text.size() && line.text[i] == ' ') ++i;
    if (i >= line.text.size() || line.text[i] != '=') fail_at(line, i, "a loop such as FOR R1=1 TO 5 is expected");
    const std::size_t to = line.text.find(" TO ", i);
    if (to == std::string::npos) fail_at(line, i, "a loop such as FOR R1=1 TO 5 is expected");
    loop.from = value(line, line.text, ++i);
    i = to + 4;
    loop.to = value(line, line.text, i);
    return loop;
  }
  void begin_for(const SiemensLine& line, std::size_t i) {
    const For loop = for_of(line, i);
    variables_[loop.name] = loop.from;
    at_ = loop.from <= loop.to ? at_ + 1 : line.partner + 1;
  }
  void next_for(const SiemensLine& head) {
    std::size_t i = head.begin;
    (void)siemens_name(head.text, i);
    const std::size_t own = at_;
    const std::string name = [&] {
      std::size_t k = i;
      return siemens_name(head.text, k);
    }();
    const double counter = variables_[name] + 1.0;
    const For loop = for_of(head, i);
    variables_[name] = counter;
    at_ = counter <= loop.to ? lines_[own].partner + 1 : own + 1;
  }

  void repeat(const SiemensLine& line, std::size_t i, bool one_block) {
    std::vector<std::string> labels;
    int times = 1;
    while (i < line.text.size()) {
      while (i < line.text.size() && line.text[i] == ' ') ++i;
      if (i >= line.text.size()) break;
      if (line.text[i] == 'P' && line.text.find('=', i) != std::string::npos &&
          line.text.find_first_not_of("P ", i) == line.text.find('=', i)) {
        i = line.text.find('=', i) + 1;
        const double n = value(line, line.text, i);
        if (!(n >= 0.0 && n <= kMostRuns && n == std::floor(n))) fail_at(line, i, fmt::format("P={:g} must be a count", n));
        times = static_cast<int>(n);
        continue;
      }
      const std::size_t column = i;
      labels.push_back(siemens_name(line.text, i));
      if (labels.back().empty()) fail_at(line, column, "a label is expected here");
    }
    if (labels.empty() || labels.size() > 2) fail_at(line, line.begin, "REPEAT requires one label or two");
    const std::size_t first = place_of(line, labels[0], line.begin, 0);
    std::size_t last = at_ - 1;
    if (labels.size() == 2) last = place_of(line, labels[1], line.begin, 0);
    if (one_block) last = first;
    if (labels.size() == 1 && !one_block && first > at_) {  // up to ENDLABEL
      last = first;
      while (last + 1 < lines_.size() && lines_[last].label != "ENDLABEL") ++last;
    }
    if (last < first || (first <= at_ && at_ <= last))
      fail_at(line, line.begin, "REPEAT must not repeat lines that contain it");
    if (times == 0) {
      ++at_;
      return;
    }
    if (repetitions_.size() >= 100) fail_at(line, line.begin, "repetitions are nested more than 100 deep");
    repetitions_.push_back({first, last, times, at_ + 1});
    at_ = first;
  }

  void end_repetitions() {
    while (!repetitions_.empty() && at_ == repetitions_.back().last + 1) {
      Repetition& r = repetitions_.back();
      if (--r.left > 0) {
        at_ = r.first;
        return;
      }
      at_ = r.back;
      repetitions_.pop_back();
    }
  }

  NcExecution& run_;
  std::vector<SiemensLine> lines_;
  std::size_t at_ = 0;
  std::map<std::string, double> variables_;
  std::vector<Repetition> repetitions_;
};

SiemensSource::SiemensSource(const std::string& path, const std::vector<std::string>& text, NcExecution& run)
    : impl_(std::make_unique<Impl>(path, text, run)) {}
SiemensSource::~SiemensSource() = default;
const SiemensLine* SiemensSource::next() {
  return impl_->next();
}
double SiemensSource::value_of(const SiemensLine& line, const std::string& text, std::size_t column, bool alone) const {
  return impl_->value_of(line, text, column, alone);
}
bool SiemensSource::is_variable(const std::string& name) const {
  return impl_->is_variable(name);
}
void SiemensSource::set_variable(const std::string& name, double value) {
  impl_->set_variable(name, value);
}

}  // namespace driftwright
