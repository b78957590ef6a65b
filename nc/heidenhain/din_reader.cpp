// One reader of one language: blocks, words and their meaning; what it shares with plain language is in execution.
#include "nc/heidenhain/din_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>

#include "base/characters.hpp"
#include "nc/arc.hpp"
#include "nc/heidenhain/execution.hpp"
#include "nc/units.hpp"
#include "nc/words.hpp"

namespace driftwright {
namespace {

std::vector<HeidenhainLine> blocks_of(const std::string& path, const std::vector<std::string>& lines) {
  std::vector<HeidenhainLine> blocks;
  int number = 0;
  for (const std::string& line : lines) {
    ++number;
    std::string text;
    for (const char c : line) {
      if (c == ';') break;
      text += (c == '\t' || c == '\r') ? ' ' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    while (!text.empty() && (text.back() == ' ' || text.back() == '*')) text.pop_back();
    std::size_t i = text.find_first_not_of(' ');
    if (i == std::string::npos) continue;
    HeidenhainLine block;
    block.where = Where{path, number, 1, "", line};
    if (text[i] == '/') {
      block.deletable = true;
      ++i;
    }
    if (i + 1 < text.size() && text[i] == 'N' && is_digit(text[i + 1])) {
      for (++i; i < text.size() && is_digit(text[i]);) ++i;
    }
    i = text.find_first_not_of(' ', i);
    if (i == std::string::npos) continue;
    if (text[i] == '/') {
      block.deletable = true;
      i = std::min(text.find_first_not_of("/ ", i), text.size());
    }
    block.text = text.substr(i);
    block.where.column = static_cast<int>(i) + 1;
    if (const std::size_t g98 = block.text.find("G98"); g98 != std::string::npos) {
      const std::size_t l = block.text.find('L', g98);
      if (l != std::string::npos)
        block.label = block.text.substr(l + 1, block.text.find_first_not_of("0123456789", l + 1) - l - 1);
    }
    blocks.push_back(std::move(block));
  }
  return blocks;
}

struct IsoWord {
  char letter = ' ';
  double value = 0.0;
  bool incremental = false;  ///< after G91
  bool computed = false;     ///< contains a Q parameter
  int number = 0;            ///< of Q200=, P01
  std::string text = {};
};

class HeidenhainReader {
 public:
  HeidenhainReader(const std::string& path, const std::vector<std::string>& lines, NcExecution& run)
      : path_(path), run_(run), lines_(blocks_of(path, lines)), tnc_(run, lines_) {}

  void run() {
    while (tnc_.at < lines_.size()) {
      const HeidenhainLine& line = lines_[tnc_.at++];
      run_.count(line.where);
      run_.begin(line.where, line.deletable);
      if (run_.motion_word && *run_.motion_word > 30)
        run_.step().before.motion = 20;  // as after an arc: an inserted line requires a motion word in the next block
      const bool ends = line.text[0] == '%'   ? percent(line)
                        : line.text[0] == 'D' ? function(line)
                        : line.text[0] == 'Q' ? formula(line)
                                              : block(line);
      run_.step().ends_program = ends;
      run_.end();
      if (ends) return;
    }
    throw InputError(
        fmt::format("{}: the program has no end; write its first line once more, M2 or M30 as its last block", path_));
  }

 private:
  /// %NAME G71: the first begins the program, the second ends it.
  bool percent(const HeidenhainLine& line) {
    if (begun_) return true;
    begun_ = true;
    const bool inch = line.text.find("G70") != std::string::npos;
    if (!inch && line.text.find("G71") == std::string::npos)
      tnc_.fail(line, "the first line has no unit; write %NAME G71 (mm) or G70 (inch)");
    run_.unit_m = inch ? kInch_m : 1e-3;
    run_.feed_unit_m = inch ? 0.1 * kInch_m : 1e-3;  // F counts tenths of an inch per minute there
    run_.step().unit_word = true;
    return false;
  }

  bool formula(const HeidenhainLine& line) {
    const std::size_t equals = line.text.find('=');
    if (equals == std::string::npos) tnc_.fail(line, "Q1 = 5 or a formula is expected");
    std::string name = line.text.substr(0, equals);
    std::erase(name, ' ');
    std::size_t i = equals + 1;
    tnc_.set_q(name, tnc_.value(line, line.text, i, true));
    return false;
  }

  /// D00 Q1 P01 +5; D09 P01 +Q1 P02 +Q3 P03 5.
  bool function(const HeidenhainLine& line) {
    const std::string& t = line.text;
    std::size_t i = 1;
    int n = 0;
    while (i < t.size() && is_digit(t[i])) n = 10 * std::min(n, 1000) + (t[i++] - '0');
    while (i < t.size() && t[i] == ' ') ++i;
    std::string q;
    while (i < t.size() && t[i] != ' ') q += t[i++];
    std::map<int, double> p;
    std::string label;
    for (std::size_t k = t.find('P'); k != std::string::npos; k = t.find('P', k + 1)) {
      std::size_t j = k + 1;
      int number = 0;
      while (j < t.size() && is_digit(t[j])) number = 10 * std::min(number, 1000) + (t[j++] - '0');
      p[number] = tnc_.value(line, t, j);
      if (number == 3) label = fmt::format("{}", std::lround(p[number]));
    }
    if (n >= 9 && n <= 12) {
      if (!p.contains(1) || !p.contains(2) || !p.contains(3)) tnc_.fail(line, "P01, P02 and P03 are required");
      if (tnc_.compares(line, n, p[1], p[2])) tnc_.go_to(line, label);
    } else if (!p.contains(1) || q.empty() || q[0] != 'Q' || !tnc_.function(line, n, q, p[1], p.contains(2) ? p[2] : 0.0)) {
      tnc_.fail(line, fmt::format("D{:02} is not known here, or what it reads is known only at the machine", n));
    }
    return false;
  }

  std::vector<IsoWord> words_of(const HeidenhainLine& line) {
    const std::string& t = line.text;
    std::vector<IsoWord> words;
    bool absolute = run_.absolute;
    for (std::size_t i = 0; i < t.size();) {
      if (t[i] == ' ') {
        ++i;
        continue;
      }
      const std::size_t begin = i;
      IsoWord word{.letter = t[i]};
      if (word.letter < 'A' || word.letter > 'Z')
        tnc_.fail(line, fmt::format("'{}' is not allowed here; words of a letter and a number are expected", t[i]));
      ++i;
      if (word.letter == 'T' && i < t.size() && t[i] == '"') {
        i = std::min(t.find('"', i + 1), t.size() - 1) + 1;
      } else if (word.letter == 'L' && i < t.size() && is_digit(t[i])) {  // L1,3
        while (i < t.size() && is_digit(t[i])) word.number = 10 * std::min(word.number, 100000) + (t[i++] - '0');
        word.value = -1.0;
        if (i < t.size() && t[i] == ',') word.value = tnc_.value(line, t, ++i);
      } else if (word.letter == 'Q' || word.letter == 'P') {
        while (i < t.size() && is_digit(t[i])) word.number = 10 * std::min(word.number, 100000) + (t[i++] - '0');
        while (i < t.size() && (t[i] == '=' || t[i] == ' ')) ++i;
        word.value = tnc_.value(line, t, i);
      } else {
        while (i < t.size() && t[i] == ' ') ++i;
        const bool bare = i >= t.size() || (std::isalpha(static_cast<unsigned char>(t[i])) != 0 && t[i] != 'Q');
        if (bare && std::string("XYZ").find(word.letter) == std::string::npos)
          tnc_.fail(line, fmt::format("'{}' is no word; a number is expected after the letter", word.letter));
        word.computed = !bare && t.find('Q', i) <= i + 1;
        if (!bare) word.value = tnc_.value(line, t, i);  // G28 X names an axis alone
      }
      word.text = t.substr(begin, i - begin);
      if (word.letter == 'G' && (word.value == 90.0 || word.value == 91.0)) absolute = word.value == 90.0;
      word.incremental = !absolute;
      words.push_back(std::move(word));
    }
    run_.absolute = absolute;
    return words;
  }

  struct Block {
    std::vector<int> g, m;
    std::map<char, IsoWord> words;
    HeidenhainCycle cycle;
    std::optional<std::pair<std::string, int>> call;  ///< label and repetitions, -1: none said
  };

  bool block(const HeidenhainLine& line) {
    Block b;
    NcStep& step = run_.step();
    step.plain = true;
    for (const IsoWord& word : words_of(line)) {
      const int code = static_cast<int>(std::lround(word.value));
      step.plain = step.plain && !word.computed && !word.incremental &&
                   (std::string("XYZF").find(word.letter) != std::string::npos ||
                    (word.letter == 'G' && (code == 0 || code == 1 || code == 90)));
      if (run_.settings().ignored.contains(fmt::format("{}{}", word.letter, code))) continue;
      if (word.letter == 'G') {
        b.g.push_back(code);
      } else if (word.letter == 'M') {
        b.m.push_back(code);
      } else if (word.letter == 'Q' || word.letter == 'P') {
        b.cycle.q[word.number] = word.value;
      } else if (word.letter == 'L' && word.number > 0) {
        b.call = {fmt::format("{}", word.number), static_cast<int>(std::lround(word.value))};
      } else if (std::string("ABCUVW").find(word.letter) != std::string::npos) {
        tnc_.fail(line, fmt::format("{}: rotary and further linear axes are not followed here; X, Y, Z are", word.text));
      } else if (!b.words.emplace(word.letter, word).second) {
        tnc_.fail(line, fmt::format("{}: a second {} in one block is not allowed", word.text, word.letter));
      }
      if (word.letter == 'F') step.feed_word = word.text;
    }
    return run_block(line, b);
  }

  static bool has(const Block& b, char letter) { return b.words.contains(letter); }
  double length_m(const Block& b, char letter) const { return b.words.at(letter).value * run_.unit_m; }

  /// What the G words of a block ask for.
  struct Asked {
    std::optional<int> cycle;
    bool dwells = false, moves = true;
  };

  void take_g(const HeidenhainLine& line, const Block& b, int g, Asked& of) {
    if (g >= 200) {
      of.cycle = g;
      of.moves = false;
      return;
    }
    if (std::set<int>{0, 1, 2, 3, 5, 6, 10, 11, 12, 13, 15, 16}.contains(g)) {
      run_.motion_word = 10 * g;
      run_.step().motion_word = true;
      return;
    }
    switch (g) {
      case 4:
        of.dwells = true;
        break;
      case 17:
      case 18:
      case 19:
        run_.normal = 19 - g;
        break;
      case 29:
        tnc_.pole_m = run_.motion.position_m;
        break;
      case 24:
      case 25:
      case 26:
      case 27:
        run_.note(fmt::format("G{}", g), "corners and tangential ways are counted as programmed, without it");
        run_.forget();
        of.moves = of.moves && (has(b, 'X') || has(b, 'Y') || has(b, 'Z'));
        break;
      case 40:
        run_.compensated = false;
        break;
      case 41:
      case 42:
      case 43:
      case 44:
        run_.compensated = true;
        run_.note(fmt::format("G{}", g),
                  "cutter compensation is not followed; the path is counted along the programmed contour");
        break;
      case 54:
        shift(line, b);
        of.moves = false;
        break;
      case 53:
        tnc_.other_datum("G53");
        of.moves = false;
        break;
      case 28:
        tnc_.mirror(has(b, 'X') || has(b, 'Y') || has(b, 'Z'), "G28");
        of.moves = false;
        break;
      case 72:
        if (!has(b, 'F') || b.words.at('F').value != 1.0)
          tnc_.fail(line, "scaling is not computed here; let the post-processor write lengths as they are");
        of.moves = false;
        break;
      case 73:
        tnc_.turn(has(b, 'H') && b.words.at('H').value != 0.0, "G73");
        of.moves = false;
        break;
      case 36:
        run_.motion.turning = false;
        of.moves = false;
        break;
      case 62:
        of.moves = false;
        break;
      case 38:
        run_.halt("G38");
        break;
      case 70:
      case 71:
      case 79:
      case 90:
      case 91:
        break;
      case 20:
      case 21:
        tnc_.fail(line,
                  fmt::format("G{}: this control's inch and mm are G70 and G71, in the first line; a tool axis but Z is "
                              "not followed here",
                              g));
      default:
        tnc_.fail(
            line,
            fmt::format("G{}: {}", g,
                        (g >= 80 && g <= 89)
                            ? "only the drilling cycles G200 to G203, G206, G207 and G240 are computed here"
                            : "its effect on times and speeds is not known here; if it has none, name it under `ignore`"));
    }
  }

  /// Feed mode, feed or dwell, and speed.
  void set_feed_and_speed(const HeidenhainLine& line, const Block& b, const Asked& of) {
    if (contains(b.m, 136)) run_.set_feed_mode(NcFeedMode::PerRevolution);
    if (contains(b.m, 137)) run_.set_feed_mode(NcFeedMode::PerMinute);
    if (of.dwells) {
      if (!has(b, 'F') || b.words.at('F').value < 0.0) tnc_.fail(line, "G04 has no time; write F in seconds");
      run_.motion.wait(b.words.at('F').value);
    } else if (has(b, 'F') && of.moves && !has(b, 'T')) {
      run_.set_feed(b.words.at('F').value);
    }
    if (has(b, 'S')) {
      if (b.words.at('S').value < 0.0) tnc_.fail(line, "the speed must be zero or above");
      run_.motion.programmed_rpm = b.words.at('S').value;
    }
  }

  HeidenhainCycle defined(const HeidenhainLine& line, const Block& b, int cycle) {
    HeidenhainCycle c = b.cycle;
    c.number = cycle;
    if (!std::set<int>{200, 201, 202, 203, 206, 207, 240}.contains(cycle))
      tnc_.fail(line,
                fmt::format("G{}: of the cycles from 200 on only 200, 201, 202, 203, 206, 207 and 240 are computed here; "
                            "write the others out",
                            cycle));
    return c;
  }

  bool run_block(const HeidenhainLine& line, const Block& b) {
    NcStep& step = run_.step();
    if (contains(b.g, 98)) {  // a label
      if (line.label == "0") tnc_.end_subprogram();
      return false;
    }
    if (contains(b.g, 99) || contains(b.g, 30) || contains(b.g, 31) || contains(b.g, 51)) {  // tool definition, blank
      if (contains(b.g, 17)) run_.normal = 2;
      return false;
    }
    Asked of;
    for (const int g : b.g) take_g(line, b, g, of);
    set_feed_and_speed(line, b, of);
    if (has(b, 'T')) tnc_.change_tool();
    for (const int m : {3, 4, 13, 14}) {
      if (contains(b.m, m)) run_.motion.turning = true;
    }
    if (of.cycle == 247)
      tnc_.other_datum("G247");
    else if (of.cycle)
      tnc_.define(defined(line, b, *of.cycle));
    else if (of.moves && !of.dwells)
      move(line, b);
    if (contains(b.g, 79)) tnc_.call_cycle();
    if (run_.modal_cycle && step.kind != NcStepKind::kNone && !contains(b.m, 99)) tnc_.call_cycle();
    bool ends = false;
    for (const int m : b.m) {
      if (m != 91) ends = tnc_.m_word(m) || ends;
    }
    if (b.call) tnc_.call(line, b.call->first, std::max(0, b.call->second));
    return ends;
  }

  void shift(const HeidenhainLine& line, const Block& b) {
    bool any = false;
    for (int axis = 0; axis < 3; ++axis) {
      const auto found = b.words.find(static_cast<char>('X' + axis));
      if (found == b.words.end()) continue;
      any = true;
      tnc_.shift_datum(axis, found->second.value * run_.unit_m, found->second.incremental);
    }
    if (!any) tnc_.fail(line, "the datum shift G54 has no X, Y or Z");
  }

  std::array<double, 3> target(const Block& b) {
    std::array<double, 3> target_m = run_.motion.position_m;
    NcStep& step = run_.step();
    for (int axis = 0; axis < 3; ++axis) {
      const auto found = b.words.find(static_cast<char>('X' + axis));
      if (found == b.words.end()) continue;
      step.named[axis] = true;
      step.absolute = step.absolute && !found->second.incremental;
      const double x_m = found->second.value * run_.unit_m;
      target_m[axis] = found->second.incremental ? target_m[axis] + x_m : x_m;
    }
    return target_m;
  }

  void set_pole(const Block& b) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto found = b.words.find(static_cast<char>('I' + axis));
      if (found == b.words.end()) continue;
      const double x_m = found->second.value * run_.unit_m;
      tnc_.pole_m[axis] = found->second.incremental ? run_.motion.position_m[axis] + x_m : x_m;
    }
  }

  std::array<double, 3> polar_target(const Block& b, int& turns) {
    const auto [u, v] = plane_axes(run_.normal);
    std::array<double, 3> target_m = target(b);
    const std::array<double, 3>& here_m = run_.motion.position_m;
    const double from = std::atan2(here_m[v] - tnc_.pole_m[v], here_m[u] - tnc_.pole_m[u]);
    const double distance_m = std::hypot(here_m[v] - tnc_.pole_m[v], here_m[u] - tnc_.pole_m[u]);
    double angle = from;
    if (has(b, 'H')) {
      const IsoWord& h = b.words.at('H');
      angle = h.incremental ? from + h.value * kDegree : h.value * kDegree;
      if (h.incremental) turns = tnc_.turns_of(h.value);
    }
    const double radius_m = has(b, 'R') ? (b.words.at('R').incremental ? distance_m : 0.0) + length_m(b, 'R') : distance_m;
    target_m[u] = tnc_.pole_m[u] + radius_m * std::cos(angle);
    target_m[v] = tnc_.pole_m[v] + radius_m * std::sin(angle);
    NcStep& step = run_.step();
    step.named[u] = step.named[v] = true;
    step.absolute = step.absolute && !(has(b, 'H') && b.words.at('H').incremental);
    return target_m;
  }

  void move(const HeidenhainLine& line, const Block& b) {
    set_pole(b);
    const int code = run_.motion_word.value_or(-10) / 10;
    const bool polar = code >= 10 && code <= 16;
    if (!has(b, 'X') && !has(b, 'Y') && !has(b, 'Z') &&
        !(polar && (has(b, 'H') || (has(b, 'R') && run_.step().motion_word))))
      return;
    if (!run_.motion_word) tnc_.fail(line, "axis words come before any motion word; write G00 or G01 first");
    const int word = *run_.motion_word;
    if (contains(b.m, 91)) {
      std::array<double, 3> target_m = run_.motion.position_m;
      const std::array<double, 3>& zero_m = run_.machine_zero("M91");
      for (int axis = 0; axis < 3; ++axis) {
        const char letter = static_cast<char>('X' + axis);
        if (!has(b, letter)) continue;
        run_.step().named[axis] = true;
        target_m[axis] = zero_m[axis] + length_m(b, letter);
      }
      tnc_.line_to(target_m, code == 0 || code == 10);
      run_.step().kind = NcStepKind::kMachine;
    } else if (code == 0 || code == 1) {
      tnc_.line_to(target(b), code == 0);
    } else if (code == 10 || code == 11) {
      int turns = 1;
      tnc_.line_to(polar_target(b, turns), code == 10);
    } else if (code == 6) {
      tnc_.tangent_arc_to(target(b));
    } else if (code == 2 || code == 3) {
      const std::array<double, 3> target_m = target(b);
      last_clockwise_ = code == 2;
      const std::array<double, 3> centre_m =
          has(b, 'R') ? run_.centre_of(target_m, length_m(b, 'R'), code == 2) : tnc_.pole_m;
      tnc_.circle_to(target_m, centre_m, code == 2, 1);
    } else if (code == 12 || code == 13) {
      int turns = 1;
      const std::array<double, 3> target_m = polar_target(b, turns);
      last_clockwise_ = code == 12;
      tnc_.circle_to(target_m, tnc_.pole_m, code == 12, turns);
    } else if (code == 5 || code == 15) {
      if (!last_clockwise_) tnc_.fail(line, "the arc has no sense; write G02 or G03");
      int turns = 1;
      const std::array<double, 3> target_m = code == 15 ? polar_target(b, turns) : target(b);
      const std::array<double, 3> centre_m =
          code == 5 && has(b, 'R') ? run_.centre_of(target_m, length_m(b, 'R'), *last_clockwise_) : tnc_.pole_m;
      tnc_.circle_to(target_m, centre_m, *last_clockwise_, turns);
    } else {
      tnc_.fail(line, fmt::format("G{}: of arcs only G02, G03, G05, G06, G12, G13 and G15 are computed here", code));
    }
    run_.motion_word = word;  // it stays in force
    if (code >= 10) run_.step().plain = false;
  }

  std::string path_;
  NcExecution& run_;
  std::vector<HeidenhainLine> lines_;
  HeidenhainExecution tnc_;
  bool begun_ = false;
  std::optional<bool> last_clockwise_;
};

}  // namespace

void run_heidenhain_program(const std::string& path, const std::vector<std::string>& lines, NcExecution& run) {
  HeidenhainReader(path, lines, run).run();
}

}  // namespace driftwright
