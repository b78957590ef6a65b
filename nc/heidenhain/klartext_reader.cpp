#include "nc/heidenhain/klartext_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "base/characters.hpp"
#include "nc/arc.hpp"
#include "nc/heidenhain/run.hpp"
#include "nc/units.hpp"

namespace driftwright {
namespace {

/// Upper case but for texts in quotation marks, without block number and comment, blanks one by one. @param number  whether there was one
std::string plain(const std::string& line, bool& deletable) {
  std::string text;
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == ';' && !quoted) break;
    const char kept = quoted                     ? c
                      : (c == '\t' || c == '\r') ? ' '
                                                 : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (kept == ' ' && (text.empty() || text.back() == ' ')) continue;
    text += kept;
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  deletable = text.starts_with('/');
  if (deletable) text.erase(0, text.find_first_not_of("/ "));
  std::size_t i = 0;
  while (i < text.size() && is_digit(text[i])) ++i;
  if (i < text.size() && text[i] == ' ') text.erase(0, i + 1);
  if (i == text.size()) text.clear();  // a number alone
  if (text.starts_with('/')) {
    deletable = true;
    text.erase(0, text.find_first_not_of("/ ") == std::string::npos ? text.size() : text.find_first_not_of("/ "));
  }
  return text;
}

/// Splits the lines into blocks: lines that end with '~' continue, and CYCL DEF 7.1 belongs to 7.0.
std::vector<HeidenhainLine> blocks_of(const std::string& path, const std::vector<std::string>& lines) {
  std::vector<HeidenhainLine> blocks;
  bool goes_on = false;
  int number = 0;
  for (const std::string& line : lines) {
    ++number;
    bool deletable = false;
    std::string text = plain(line, deletable);
    if (text.empty() || text.starts_with('*')) continue;
    const auto last = line.find_last_not_of(" \t\r");
    const bool more = line[last] == '~';  // also after a comment
    while (!text.empty() && (text.back() == ' ' || text.back() == '~')) text.pop_back();
    const bool sub_line = text.starts_with("CYCL DEF ") && [&] {
      const std::size_t dot = text.find('.');
      return dot != std::string::npos && dot + 1 < text.size() && text[dot + 1] != '0' && text.find(' ', 9) > dot;
    }();
    if (goes_on && !blocks.empty()) {
      blocks.back().text += " " + text;
    } else if (sub_line && !blocks.empty() && blocks.back().text.starts_with("CYCL DEF ")) {
      const std::size_t behind = text.find(' ', 9);
      blocks.back().text += behind == std::string::npos ? "" : text.substr(behind);
    } else {
      HeidenhainLine block;
      block.where = Where{path, number, 1, "", line};
      block.text = text;
      block.deletable = deletable;
      if (text.starts_with("LBL ")) {
        block.label = text.substr(4);
        std::erase(block.label, '"');
      }
      blocks.push_back(std::move(block));
    }
    blocks.back().last_line = number;
    goes_on = more;
  }
  return blocks;
}

/// The words after the first word of a path block.
struct Path {
  std::array<std::optional<double>, 3> at = {}, by = {};  ///< X and IX, as written
  std::optional<double> pr, pa, ipr, ipa, radius, length, angle, mb;
  std::optional<bool> clockwise;
  bool rapid = false, automatic = false, mb_max = false;
  std::optional<double> feed;
  std::optional<char> side;  ///< '0', 'L', 'R'
  std::vector<int> m;
  bool plain = true;
  std::string feed_word;
};

class KlartextReader {
 public:
  KlartextReader(const std::string& path, const std::vector<std::string>& lines, NcRun& run)
      : path_(path), run_(run), lines_(blocks_of(path, lines)), tnc_(run, lines_) {}

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
  [[noreturn]] void fail(const HeidenhainLine& line, const std::string& message) const {
    throw InputError(line.where, message);
  }

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
      if (!inch && !t.ends_with(" MM")) fail(line, "BEGIN PGM has no unit; write MM or INCH at its end");
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
    if (begins(t, "CALL PGM")) fail(line, "other programs are not called here; let the post-processor write them out");
    if (begins(t, "TOOL CALL")) return tool_call(line);
    if (begins(t, "CYCL DEF")) return define_cycle(line), false;
    if (begins(t, "CYCL CALL")) return call_cycle(line);
    if (t.starts_with("FN")) return function(line), false;
    if (t.starts_with("Q")) return formula(line), false;
    if (begins(t, "STOP")) {
      run_.halt("STOP");
      return m_words(line, path_words(line, 4));
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
    if (t.starts_with('M')) return m_words(line, path_words(line, 0));
    const std::string word = t.substr(0, t.find(' '));
    if (ignored(word)) return false;
    fail(line, fmt::format("{} is not known here; if it has no effect on times and speeds, name it under `ignore`", word));
  }

  // --- words of a path block
  // ----------------------------------------------------------------------------------------------------

  Path path_words(const HeidenhainLine& line, std::size_t i) {
    const std::string& t = line.text;
    Path p;
    const auto is = [&](const char* word) {
      const std::string w = word;
      if (t.compare(i, w.size(), w) != 0) return false;
      i += w.size();
      return true;
    };
    const auto value = [&] { return tnc_.value(line, t, i); };
    while (true) {
      while (i < t.size() && t[i] == ' ') ++i;
      if (i >= t.size()) return p;
      const std::size_t begin = i;
      const bool is_axis =
          (t[i] >= 'X' && t[i] <= 'Z') || (t[i] == 'I' && i + 1 < t.size() && t[i + 1] >= 'X' && t[i + 1] <= 'Z');
      if (is_axis) {
        const bool incremental = t[i] == 'I';
        const int axis = t[incremental ? ++i : i] - 'X';
        ++i;
        auto& place = incremental ? p.by[axis] : p.at[axis];
        if (place) fail(line, fmt::format("a second {} in one block is not allowed", t.substr(begin, i - begin)));
        place = value();
        p.plain = p.plain && !incremental && t.find('Q', begin) >= i;
        continue;
      }
      if (is("IPA")) {
        p.ipa = value();
      } else if (is("IPR")) {
        p.ipr = value();
      } else if (is("PA")) {
        p.pa = value();
      } else if (is("PR")) {
        p.pr = value();
      } else if (is("DR+") || is("DR-")) {
        p.clockwise = t[i - 1] == '-';
      } else if (is("R0") || is("RL") || is("RR")) {
        p.side = t[i - 1];
        continue;
      } else if (is("FMAX") || is("F MAX")) {
        p.rapid = true;
        continue;
      } else if (is("FAUTO") || is("F AUTO")) {
        p.automatic = true;
        p.feed_word = "F AUTO";
        continue;
      } else if (is("FU") || is("FZ") || is("FT")) {
        fail(line, fmt::format("{}: this must be a feed per minute", t.substr(begin, 2)));
      } else if (is("F")) {
        p.feed = value();
        p.feed_word = t.substr(begin, i - begin);
        continue;
      } else if (is("MB MAX") || is("MB-MAX")) {
        p.mb_max = true;
      } else if (is("MB")) {
        p.mb = value();
      } else if (is("M")) {
        p.m.push_back(static_cast<int>(value()));
      } else if (is("LEN")) {
        p.length = value();
      } else if (is("CCA")) {
        p.angle = value();
      } else if (is("R")) {
        p.radius = value();
      } else if (is("LA")) {  // of M120
        (void)value();
      } else {
        fail(line, fmt::format("'{}' is not known here", t.substr(i, t.find(' ', i) - i)));
      }
      p.plain = false;
    }
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
      fail(line, "M140 requires MB and its length, or MB MAX");
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
    if (!p.pa && !p.ipa && !p.pr && !p.ipr) fail(line, "polar coordinates require PR or PA");
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
    const Path p = path_words(line, word.size());
    NcStep& step = run_.step();
    step.plain = p.plain && word == "L" && !p.side;
    step.feed_word = p.feed_word;
    side(p);
    if (p.feed) run_.set_feed(*p.feed);
    if (p.automatic) {
      if (!automatic_feed_) fail(line, "F AUTO requires a feed in TOOL CALL");
      run_.motion.feed = *automatic_feed_;
    }
    if (std::find(p.m.begin(), p.m.end(), 3) != p.m.end() || std::find(p.m.begin(), p.m.end(), 13) != p.m.end() ||
        std::find(p.m.begin(), p.m.end(), 4) != p.m.end() || std::find(p.m.begin(), p.m.end(), 14) != p.m.end())
      run_.motion.turning = true;  // at the start of the block
    move(line, word, p);
    if (run_.modal_cycle && std::find(p.m.begin(), p.m.end(), 99) == p.m.end()) tnc_.call_cycle();
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
      if (std::find(p.m.begin(), p.m.end(), 91) != p.m.end()) {
        std::array<double, 3> target_m = run_.motion.position_m;
        const std::array<double, 3>& zero_m = run_.machine_zero("M91");
        for (int axis = 0; axis < 3; ++axis) {
          if (p.by[axis]) fail(line, "M91 does not allow an incremental coordinate");
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
    if (!clockwise) fail(line, "the arc has no sense; write DR+ or DR-");
    last_clockwise_ = clockwise;
    if (word == "CR") {
      if (!p.radius) fail(line, "CR requires its radius R");
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
    const Path p = path_words(line, end);
    run_.note(word, "the way to or from the contour is counted as a straight line at the feed");
    side(p);
    if (p.feed) run_.set_feed(*p.feed);
    const bool any = std::any_of(p.at.begin(), p.at.end(), [](const auto& x) { return x.has_value(); });
    if (any) {
      tnc_.line_to(target(p), p.rapid);
    } else if (p.length || p.radius) {
      const double length_m =
          (p.length ? std::abs(*p.length) : std::abs(*p.radius) * p.angle.value_or(90.0) * kDegree) * run_.unit_m;
      if (!(run_.motion.feed > 0.0)) fail(line, "the feed move has no feed");
      run_.motion.wait(length_m / run_.motion.feed);
    } else {
      fail(line, fmt::format("{} {} requires its end, LEN or R", word, kind));
    }
    if (word == "DEP") run_.compensated = false;
    run_.forget();
    run_.step().no_place = true;
    return m_words(line, p);
  }

  void pole(const HeidenhainLine& line) {
    const Path p = path_words(line, 2);
    for (int axis = 0; axis < 3; ++axis) {
      if (p.at[axis]) tnc_.pole_m[axis] = *p.at[axis] * run_.unit_m;
      if (p.by[axis]) tnc_.pole_m[axis] = run_.motion.position_m[axis] + *p.by[axis] * run_.unit_m;
    }
    if (line.text == "CC") tnc_.pole_m = run_.motion.position_m;
  }

  // --- the rest
  // -----------------------------------------------------------------------------------------------------------------

  void call_label(const HeidenhainLine& line) {
    std::string label = line.text.substr(9);
    int times = 0;
    if (const std::size_t rep = label.find(" REP"); rep != std::string::npos) {
      std::string count = label.substr(rep + 4);
      std::erase(count, ' ');
      std::size_t i = 0;
      const double n = count.empty() ? 1.0 : tnc_.value(line, count, i);
      if (!(n >= 1.0 && n <= kMostRuns && n == std::floor(n)))
        fail(line, fmt::format("REP {} must be a count from 1", count));
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
        if (i == std::string::npos) fail(line, "the tool's name has no closing '\"'");
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
        if (run_.motion.programmed_rpm < 0.0) fail(line, "the speed must be zero or above");
      } else if (c == 'F') {
        const double before = run_.motion.feed;
        run_.set_feed(tnc_.value(line, t, ++i));
        automatic_feed_ = run_.motion.feed;
        if (!named) run_.motion.feed = before;
      } else if (t.compare(i, 2, "DL") == 0 || t.compare(i, 2, "DR") == 0) {
        i += t.compare(i, 3, "DR2") == 0 ? 3 : 2;
        (void)tnc_.value(line, t, i);
      } else {
        fail(line, fmt::format("'{}' is not known in TOOL CALL", t.substr(i, t.find(' ', i) - i)));
      }
    }
    if (named) tnc_.change_tool();
    return false;
  }

  /// Words and their values after a cycle's title, such as X+10 of cycle 7.
  void define_cycle(const HeidenhainLine& line) {
    const std::string& t = line.text;
    std::size_t i = 9;
    int number = 0;
    while (i < t.size() && is_digit(t[i])) number = 10 * std::min(number, 100000) + (t[i++] - '0');
    if (i < t.size() && t[i] == '.') {
      while (i < t.size() && t[i] != ' ') ++i;
    }
    switch (number) {
      case 7:
        return datum(line, i);
      case 8:
        return tnc_.mirror(std::any_of(t.begin() + static_cast<std::ptrdiff_t>(title_end(t, i)), t.end(),
                                       [](char c) { return c >= 'X' && c <= 'Z'; }),
                           "CYCL DEF 8");
      case 9:
        return run_.motion.wait(last_number(line, i));
      case 10:
        return tnc_.turn(t.find("ROT", t.find("ROT", i) + 3) != std::string::npos ? last_number(line, t.rfind("ROT")) != 0.0
                                                                                  : last_number(line, i) != 0.0,
                         "CYCL DEF 10");
      case 11:
        if (last_number(line, i) != 1.0)
          fail(line, "scaling is not computed here; let the post-processor write lengths as they are");
        return;
      case 13:
        run_.motion.turning = false;
        return;
      case 32:
        return;
      case 247:
        return tnc_.other_datum("CYCL DEF 247");
      default:
        break;
    }
    if (number < 200)
      fail(line, fmt::format(
                     "CYCL DEF {} is not known here; cycles 7 to 11, 13, 32, 247, 200, 201, 202, 203, 206, 207 and 240 are",
                     number));
    HeidenhainCycle cycle{.number = number, .q = {}};
    for (std::size_t q = t.find(" Q", i); q != std::string::npos; q = t.find(" Q", q + 1)) {
      std::size_t k = q + 2;
      int n = 0;
      while (k < t.size() && is_digit(t[k])) n = 10 * std::min(n, 100000) + (t[k++] - '0');
      while (k < t.size() && t[k] == ' ') ++k;
      if (k == q + 2 || k >= t.size() || t[k] != '=') continue;  // part of the title
      ++k;
      cycle.q[n] = tnc_.value(line, t, k);
      tnc_.set_q(fmt::format("Q{}", n), cycle.q[n]);
    }
    if (cycle.q.empty()) fail(line, fmt::format("CYCL DEF {} has no Q parameters", number));
    if (std::set<int>{200, 201, 202, 203, 206, 207, 240}.contains(number)) return tnc_.define(cycle);
    fail(line,
         fmt::format("CYCL DEF {}: of the cycles from 200 on only 200, 201, 202, 203, 206, 207 and 240 are computed here; "
                     "write the others out",
                     number));
  }

  /// Index after the words of a title: where the first value begins.
  static std::size_t title_end(const std::string& t, std::size_t i) {
    while (i < t.size()) {
      const std::size_t begin = t.find_first_not_of(' ', i);
      if (begin == std::string::npos) return t.size();
      const std::size_t end = std::min(t.find(' ', begin), t.size());
      const std::string word = t.substr(begin, end - begin);
      if (word.size() <= 1 || word.find_first_of("+-#0123456789") != std::string::npos) return begin;
      i = end;
    }
    return t.size();
  }

  double last_number(const HeidenhainLine& line, std::size_t i) {
    const std::string& t = line.text;
    const std::size_t begin = t.find_first_of("+-0123456789", i);
    if (begin == std::string::npos) fail(line, "the cycle has no number");
    std::size_t k = begin;
    if (k > 0 && t[k - 1] == 'Q') --k;
    return tnc_.value(line, t, k);
  }

  void datum(const HeidenhainLine& line, std::size_t i) {
    const std::string& t = line.text;
    i = title_end(t, i);
    bool any = false;
    while (i < t.size()) {
      if (t[i] == ' ') {
        ++i;
        continue;
      }
      if (t[i] == '#') return tnc_.other_datum("CYCL DEF 7 #");
      const bool incremental = t[i] == 'I';
      if (incremental) ++i;
      if (i >= t.size() || t[i] < 'X' || t[i] > 'Z') fail(line, fmt::format("'{}' is no shift of X, Y or Z", t.substr(i)));
      const int axis = t[i++] - 'X';
      tnc_.shift_datum(axis, tnc_.value(line, t, i) * run_.unit_m, incremental);
      any = true;
    }
    if (!any) fail(line, "the datum shift has no X, Y or Z");
  }

  bool call_cycle(const HeidenhainLine& line) {
    const std::string& t = line.text;
    if (begins(t, "CYCL CALL PAT")) fail(line, "patterns are not followed here; write the positions out");
    const bool positions = begins(t, "CYCL CALL POS");
    const Path p = path_words(line, positions ? 13 : 9);
    if (std::find(p.m.begin(), p.m.end(), 3) != p.m.end() || std::find(p.m.begin(), p.m.end(), 13) != p.m.end())
      run_.motion.turning = true;
    if (positions) {
      if (p.feed) run_.set_feed(*p.feed);
      tnc_.line_to(target(p), p.rapid);
    }
    tnc_.call_cycle();
    return m_words(line, p);
  }

  void formula(const HeidenhainLine& line) {
    const std::size_t equals = line.text.find('=');
    if (equals == std::string::npos) fail(line, "Q1 = 5 or a formula is expected");
    std::string name = line.text.substr(0, equals);
    std::erase(name, ' ');
    if (name.starts_with("QS")) return;  // texts
    std::size_t i = equals + 1;
    tnc_.set_q(name, tnc_.value(line, line.text, i, true));
    if (line.text.find_first_not_of(' ', i) != std::string::npos)
      fail(line, fmt::format("'{}' is not allowed here", line.text.substr(i)));
  }

  /// FN 1: Q5 = +Q2 + +5; FN 9: IF +Q1 EQU +Q3 GOTO LBL 5.
  void function(const HeidenhainLine& line) {
    const std::string& t = line.text;
    std::size_t i = 2;
    while (i < t.size() && t[i] == ' ') ++i;
    int n = 0;
    while (i < t.size() && is_digit(t[i])) n = 10 * std::min(n, 1000) + (t[i++] - '0');
    if (i >= t.size() || t[i] != ':') fail(line, "FN and its number are expected, such as FN 0: Q1 = +5");
    ++i;
    if (n >= 9 && n <= 12) {
      const std::size_t condition = t.find("IF", i), jump = t.find("GOTO LBL");
      if (condition == std::string::npos || jump == std::string::npos) fail(line, "IF ... GOTO LBL is expected");
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
    if (equals == std::string::npos) fail(line, fmt::format("FN {} is not known here", n));
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
    if (!tnc_.function(line, n, q, a, b)) fail(line, fmt::format("FN {}: what it reads is known only at the machine", n));
  }

  std::string path_;
  NcRun& run_;
  std::vector<HeidenhainLine> lines_;
  HeidenhainRun tnc_;
  std::optional<bool> last_clockwise_;
  std::optional<double> automatic_feed_;  // of TOOL CALL, as NcMotion::feed
};

}  // namespace

bool is_klartext(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    bool deletable = false;
    const std::string text = plain(line, deletable);
    if (!text.empty() && !text.starts_with('*')) return text.starts_with("BEGIN PGM");
  }
  return false;
}

void run_klartext_program(const std::string& path, const std::vector<std::string>& lines, NcRun& run) {
  KlartextReader(path, lines, run).run();
}

}  // namespace driftwright
