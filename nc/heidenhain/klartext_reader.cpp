// One reader of one language: what it shares with DIN/ISO is in execution.
#include "nc/heidenhain/klartext_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/characters.hpp"
#include "nc/arc.hpp"
#include "nc/heidenhain/klartext_cycles.hpp"
#include "nc/heidenhain/klartext_lines.hpp"
#include "nc/units.hpp"
#include "nc/words.hpp"

namespace driftwright {
namespace {

class KlartextReader {
 public:
  KlartextReader(const std::string& path, const std::vector<std::string>& lines, NcExecution& run)
      : path_(path), run_(run), lines_(klartext_blocks(path, lines)), tnc_(run, lines_) {}

  void run() {
    while (tnc_.at < lines_.size()) {
      const HeidenhainLine& line = lines_[tnc_.at++];
      run_.count(line.where);
      run_.begin(line.where, line.deletable);
      run_.step().motion_word = true;  // each path block names its motion
      run_.step().last_line = line.last_line;
      const bool ends = block(line);
      run_.step().ends_program = ends;
      run_.end();
      if (ends) return;
    }
    throw InputError(fmt::format("{}: the program has no end; write END PGM, M2 or M30", path_));
  }

 private:
  using Path = KlartextPath;

  static bool begins(const std::string& text, const char* word) {
    const std::string w = word;
    return text.compare(0, w.size(), w) == 0 && (text.size() == w.size() || text[w.size()] == ' ');
  }

  bool ignored(const std::string& word) const { return run_.settings().ignored.contains(word); }

  /// @returns true  if it ends the program
  bool block(const HeidenhainLine& line) {
    const std::string& t = line.text;
    if (begins(t, "BEGIN PGM")) {
      const bool inch = t.ends_with(" INCH");
      if (!inch && !t.ends_with(" MM")) tnc_.fail(line, "BEGIN PGM has no unit; write MM or INCH at its end");
      run_.unit_m = inch ? kInch_m : 1e-3;
      run_.feed_unit_m = inch ? 0.1 * kInch_m : 1e-3;  // F counts tenths of an inch per minute there
      run_.step().unit_word = true;
      return false;
    }
    if (begins(t, "END PGM")) return true;
    if (begins(t, "BLK FORM") || begins(t, "TOOL DEF") || begins(t, "FN 15:") || begins(t, "FN 16:") ||
        t == "PLANE RESET STAY" || begins(t, "FUNCTION MODE MILL") || begins(t, "FUNCTION PROG PATH"))
      return false;
    if (begins(t, "LBL")) {
      if (line.label == "0") tnc_.end_subprogram();
      return false;
    }
    if (begins(t, "CALL LBL")) return call_label(line), false;
    if (begins(t, "CALL PGM")) tnc_.fail(line, "other programs are not called here; let the post-processor write them out");
    if (begins(t, "TOOL CALL")) return tool_call(line);
    if (begins(t, "CYCL DEF")) return define_klartext_cycle(line, tnc_, run_), false;
    if (begins(t, "CYCL CALL")) return call_cycle(line);
    if (t.starts_with("FN")) return function(line), false;
    if (t.starts_with("Q")) return formula(line), false;
    if (begins(t, "STOP")) {
      run_.halt("STOP");
      return m_words(line, klartext_path(tnc_, line, 4));
    }
    if (begins(t, "CC")) return pole(line), false;
    for (const char* word : {"APPR", "DEP"}) {
      if (begins(t, word)) return approach(line, word);
    }
    for (const char* word : {"LP", "L", "CTP", "CT", "CP", "CR", "C"}) {
      if (begins(t, word)) return path(line, word);
    }
    if (begins(t, "RND") || begins(t, "CHF") || t.starts_with("RND") || t.starts_with("CHF")) {
      run_.note(t.substr(0, 3), "corners are counted as programmed, not as rounded or broken");
      run_.forget();
      return false;
    }
    if (t.starts_with('M')) return m_words(line, klartext_path(tnc_, line, 0));
    const std::string word = t.substr(0, t.find(' '));
    if (ignored(word)) return false;
    tnc_.fail(line,
              fmt::format("{} is not known here; if it has no effect on times and speeds, name it under `ignore`", word));
  }

  /// @returns true  if one ends the program
  bool m_words(const HeidenhainLine& line, const Path& p) {
    bool ends = false;
    for (const int m : p.m) {
      if (ignored(fmt::format("M{}", m)) || m == 91) continue;
      if (m == 140) {
        retract(line, p);
      } else {
        ends = tnc_.m_word(m) || ends;
      }
    }
    if (run_.step().kind == NcStepKind::kDrilling) run_.motion_word = 0;  // cycles end with a rapid
    return ends;
  }

  void retract(const HeidenhainLine& line, const Path& p) {
    std::array<double, 3> target_m = run_.motion.position_m;
    if (p.mb_max) {
      target_m[run_.normal] = run_.machine_zero("M140 MB MAX")[run_.normal];
    } else if (p.mb) {
      target_m[run_.normal] += *p.mb * run_.unit_m;
    } else {
      tnc_.fail(line, "M140 requires MB and its length, or MB MAX");
    }
    run_.step().named[run_.normal] = true;
    tnc_.line_to(target_m, !p.feed);
    run_.step().kind = NcStepKind::kMachine;
  }

  std::array<double, 3> target(const Path& p) {
    std::array<double, 3> target_m = run_.motion.position_m;
    NcStep& step = run_.step();
    for (int axis = 0; axis < 3; ++axis) {
      if (p.at[axis]) target_m[axis] = *p.at[axis] * run_.unit_m;
      if (p.by[axis]) target_m[axis] += *p.by[axis] * run_.unit_m;
      step.named[axis] = p.at[axis] || p.by[axis];
      step.absolute = step.absolute && !p.by[axis];
    }
    return target_m;
  }

  std::array<double, 3> polar_target(const HeidenhainLine& line, const Path& p, int& turns, std::optional<bool>& clockwise) {
    const auto [u, v] = plane_axes(run_.normal);
    const std::array<double, 3>& here_m = run_.motion.position_m;
    std::array<double, 3> target_m = target(p);
    const double from = std::atan2(here_m[v] - tnc_.pole_m[v], here_m[u] - tnc_.pole_m[u]);
    const double distance_m = std::hypot(here_m[v] - tnc_.pole_m[v], here_m[u] - tnc_.pole_m[u]);
    if (!p.pa && !p.ipa && !p.pr && !p.ipr) tnc_.fail(line, "polar coordinates require PR or PA");
    const double angle = p.ipa ? from + *p.ipa * kDegree : p.pa ? *p.pa * kDegree : from;
    const double radius_m = p.ipr ? distance_m + *p.ipr * run_.unit_m : p.pr ? *p.pr * run_.unit_m : distance_m;
    target_m[u] = tnc_.pole_m[u] + radius_m * std::cos(angle);
    target_m[v] = tnc_.pole_m[v] + radius_m * std::sin(angle);
    NcStep& step = run_.step();
    step.named[u] = step.named[v] = true;
    step.absolute = step.absolute && !p.ipa && !p.ipr;
    if (p.ipa) {
      turns = tnc_.turns_of(*p.ipa);
      if (!clockwise) clockwise = *p.ipa < 0.0;
    }
    return target_m;
  }

  bool path(const HeidenhainLine& line, const std::string& word) {
    const Path p = klartext_path(tnc_, line, word.size());
    NcStep& step = run_.step();
    step.plain = p.plain && word == "L" && !p.side;
    step.feed_word = p.feed_word;
    side(p);
    if (p.feed) run_.set_feed(*p.feed);
    if (p.automatic) {
      if (!automatic_feed_) tnc_.fail(line, "F AUTO requires a feed in TOOL CALL");
      run_.motion.feed = *automatic_feed_;
    }
    if (contains(p.m, 3) || contains(p.m, 13) || contains(p.m, 4) || contains(p.m, 14))
      run_.motion.turning = true;  // at the start of the block
    move(line, word, p);
    if (run_.modal_cycle && !contains(p.m, 99)) tnc_.call_cycle();
    return m_words(line, p);
  }

  void move(const HeidenhainLine& line, const std::string& word, const Path& p) {
    NcStep& step = run_.step();
    const bool any = std::any_of(p.at.begin(), p.at.end(), [](const auto& x) { return x.has_value(); }) ||
                     std::any_of(p.by.begin(), p.by.end(), [](const auto& x) { return x.has_value(); });
    int turns = 1;
    std::optional<bool> clockwise = p.clockwise;
    if (word == "L" || word == "LP") {
      if (!any && word == "L") return;
      if (contains(p.m, 91)) {
        std::array<double, 3> target_m = run_.motion.position_m;
        const std::array<double, 3>& zero_m = run_.machine_zero("M91");
        for (int axis = 0; axis < 3; ++axis) {
          if (p.by[axis]) tnc_.fail(line, "M91 does not allow an incremental coordinate");
          if (!p.at[axis]) continue;
          step.named[axis] = true;
          target_m[axis] = zero_m[axis] + *p.at[axis] * run_.unit_m;
        }
        tnc_.line_to(target_m, p.rapid);
        step.kind = NcStepKind::kMachine;
        return;
      }
      tnc_.line_to(word == "L" ? target(p) : polar_target(line, p, turns, clockwise), p.rapid);
      return;
    }
    if (word == "CT" || word == "CTP") {
      tnc_.tangent_arc_to(word == "CT" ? target(p) : polar_target(line, p, turns, clockwise));
      return;
    }
    const std::array<double, 3> target_m = word == "CP" ? polar_target(line, p, turns, clockwise) : target(p);
    if (!clockwise) clockwise = last_clockwise_;
    if (!clockwise) tnc_.fail(line, "the arc has no sense; write DR+ or DR-");
    last_clockwise_ = clockwise;
    if (word == "CR") {
      if (!p.radius) tnc_.fail(line, "CR requires its radius R");
      tnc_.circle_to(target_m, run_.centre_of(target_m, *p.radius * run_.unit_m, *clockwise), *clockwise, 1);
    } else {
      tnc_.circle_to(target_m, tnc_.pole_m, *clockwise, turns);
    }
  }

  void side(const Path& p) {
    if (!p.side) return;
    run_.compensated = *p.side != '0';
    if (run_.compensated)
      run_.note(std::string("R") + *p.side,
                "cutter compensation is not followed; the path is counted along the programmed contour");
  }

  bool approach(const HeidenhainLine& line, const std::string& word) {
    std::size_t i = word.size() + 1;
    const std::size_t end = std::min(line.text.find(' ', i), line.text.size());
    const std::string kind = line.text.substr(i, end - i);
    const Path p = klartext_path(tnc_, line, end);
    run_.note(word, "the way to or from the contour is counted as a straight line at the feed");
    side(p);
    if (p.feed) run_.set_feed(*p.feed);
    const bool any = std::any_of(p.at.begin(), p.at.end(), [](const auto& x) { return x.has_value(); });
    if (any) {
      tnc_.line_to(target(p), p.rapid);
    } else if (p.length || p.radius) {
      const double length_m =
          (p.length ? std::abs(*p.length) : std::abs(*p.radius) * p.angle.value_or(90.0) * kDegree) * run_.unit_m;
      if (!(run_.motion.feed > 0.0)) tnc_.fail(line, "the feed move has no feed");
      run_.motion.wait(length_m / run_.motion.feed);
    } else {
      tnc_.fail(line, fmt::format("{} {} requires its end, LEN or R", word, kind));
    }
    if (word == "DEP") run_.compensated = false;
    run_.forget();
    run_.step().no_place = true;
    return m_words(line, p);
  }

  void pole(const HeidenhainLine& line) {
    const Path p = klartext_path(tnc_, line, 2);
    for (int axis = 0; axis < 3; ++axis) {
      if (p.at[axis]) tnc_.pole_m[axis] = *p.at[axis] * run_.unit_m;
      if (p.by[axis]) tnc_.pole_m[axis] = run_.motion.position_m[axis] + *p.by[axis] * run_.unit_m;
    }
    if (line.text == "CC") tnc_.pole_m = run_.motion.position_m;
  }

  // --- the rest

  void call_label(const HeidenhainLine& line) {
    std::string label = line.text.substr(9);
    int times = 0;
    if (const std::size_t rep = label.find(" REP"); rep != std::string::npos) {
      std::string count = label.substr(rep + 4);
      std::erase(count, ' ');
      std::size_t i = 0;
      const double n = count.empty() ? 1.0 : tnc_.value(line, count, i);
      if (!(n >= 1.0 && n <= kMostRuns && n == std::floor(n)))
        tnc_.fail(line, fmt::format("REP {} must be a count from 1", count));
      times = static_cast<int>(n);
      label.erase(rep);
    }
    std::erase(label, '"');
    std::erase(label, ' ');
    tnc_.call(line, label, times);
  }

  bool tool_call(const HeidenhainLine& line) {
    const std::string& t = line.text;
    std::size_t i = 9;
    bool named = false;
    while (true) {
      while (i < t.size() && t[i] == ' ') ++i;
      if (i >= t.size()) break;
      const char c = t[i];
      if (c == '"') {
        i = t.find('"', i + 1);
        if (i == std::string::npos) tnc_.fail(line, "the tool's name has no closing '\"'");
        ++i;
        named = true;
      } else if (is_digit(c) || c == 'Q') {
        (void)tnc_.value(line, t, i);
        if (i < t.size() && t[i] == '.') ++i;
        named = true;
      } else if (c >= 'X' && c <= 'Z') {
        run_.normal = c - 'X';
        ++i;
      } else if (c == 'S') {
        run_.motion.programmed_rpm = tnc_.value(line, t, ++i);
        if (run_.motion.programmed_rpm < 0.0) tnc_.fail(line, "the speed must be zero or above");
      } else if (c == 'F') {
        const double before = run_.motion.feed;
        run_.set_feed(tnc_.value(line, t, ++i));
        automatic_feed_ = run_.motion.feed;
        if (!named) run_.motion.feed = before;
      } else if (t.compare(i, 2, "DL") == 0 || t.compare(i, 2, "DR") == 0) {
        i += t.compare(i, 3, "DR2") == 0 ? 3 : 2;
        (void)tnc_.value(line, t, i);
      } else {
        tnc_.fail(line, fmt::format("'{}' is not known in TOOL CALL", t.substr(i, t.find(' ', i) - i)));
      }
    }
    if (named) tnc_.change_tool();
    return false;
  }

  bool call_cycle(const HeidenhainLine& line) {
    const std::string& t = line.text;
    if (begins(t, "CYCL CALL PAT")) tnc_.fail(line, "patterns are not followed here; write the positions out");
    const bool positions = begins(t, "CYCL CALL POS");
    const Path p = klartext_path(tnc_, line, positions ? 13 : 9);
    if (contains(p.m, 3) || contains(p.m, 13)) run_.motion.turning = true;
    if (positions) {
      if (p.feed) run_.set_feed(*p.feed);
      tnc_.line_to(target(p), p.rapid);
    }
    tnc_.call_cycle();
    return m_words(line, p);
  }

  void formula(const HeidenhainLine& line) {
    const std::size_t equals = line.text.find('=');
    if (equals == std::string::npos) tnc_.fail(line, "Q1 = 5 or a formula is expected");
    std::string name = line.text.substr(0, equals);
    std::erase(name, ' ');
    if (name.starts_with("QS")) return;  // texts
    std::size_t i = equals + 1;
    tnc_.set_q(name, tnc_.value(line, line.text, i, true));
    if (line.text.find_first_not_of(' ', i) != std::string::npos)
      tnc_.fail(line, fmt::format("'{}' is not allowed here", line.text.substr(i)));
  }

  /// FN 1: Q5 = +Q2 + +5; FN 9: IF +Q1 EQU +Q3 GOTO LBL 5.
  void function(const HeidenhainLine& line) {
    const std::string& t = line.text;
    std::size_t i = 2;
    while (i < t.size() && t[i] == ' ') ++i;
    int n = 0;
    while (i < t.size() && is_digit(t[i])) n = 10 * std::min(n, 1000) + (t[i++] - '0');
    if (i >= t.size() || t[i] != ':') tnc_.fail(line, "FN and its number are expected, such as FN 0: Q1 = +5");
    ++i;
    if (n >= 9 && n <= 12) {
      const std::size_t condition = t.find("IF", i), jump = t.find("GOTO LBL");
      if (condition == std::string::npos || jump == std::string::npos) tnc_.fail(line, "IF ... GOTO LBL is expected");
      i = condition + 2;
      const double a = tnc_.value(line, t, i);
      i = t.find_first_of("ENGL", i);  // EQU, NE, GT, LT
      while (i < jump && t[i] != ' ') ++i;
      const double b = tnc_.value(line, t, i);
      std::string label = t.substr(jump + 8);
      std::erase(label, ' ');
      std::erase(label, '"');
      if (tnc_.compares(line, n, a, b)) tnc_.go_to(line, label);
      return;
    }
    const std::size_t equals = t.find('=', i);
    if (equals == std::string::npos) tnc_.fail(line, fmt::format("FN {} is not known here", n));
    std::string q = t.substr(i, equals - i);
    std::erase(q, ' ');
    i = equals + 1;
    while (i < t.size() && t[i] == ' ') ++i;
    for (const char* word : {"SQRT", "SIN", "COS"}) {
      if (t.compare(i, std::string(word).size(), word) == 0) i += std::string(word).size();
    }
    const double a = tnc_.value(line, t, i);
    double b = 0.0;
    if (n != 0 && n != 5 && n != 6 && n != 7) {
      while (i < t.size() && t[i] == ' ') ++i;
      for (const char* word : {"DIV", "LEN", "ANG", "*", "+", "-"}) {
        if (t.compare(i, std::string(word).size(), word) != 0) continue;
        i += std::string(word).size();
        break;
      }
      b = tnc_.value(line, t, i);
    }
    if (!tnc_.function(line, n, q, a, b))
      tnc_.fail(line, fmt::format("FN {}: what it reads is known only at the machine", n));
  }

  std::string path_;
  NcExecution& run_;
  std::vector<HeidenhainLine> lines_;
  HeidenhainExecution tnc_;
  std::optional<bool> last_clockwise_;
  std::optional<double> automatic_feed_;  // of TOOL CALL, as NcMotion::feed
};

}  // namespace

void run_klartext_program(const std::string& path, const std::vector<std::string>& lines, NcExecution& run) {
  KlartextReader(path, lines, run).run();
}

}  // namespace driftwright
