#include "nc/siemens/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "nc/arc.hpp"
#include "nc/expression.hpp"
#include "nc/siemens/lines.hpp"
#include "nc/tapping.hpp"
#include "nc/units.hpp"

namespace driftwright {
namespace {

const std::set<std::string>& keywords_without_effect() {
  static const std::set<std::string> kWords = {
      "SOFT",   "BRISK",    "DRIVE",     "SOFTA",    "BRISKA",   "FFWON",   "FFWOF",     "COMPCAD", "COMPON",
      "COMPOF", "COMPCURV", "COMPSURF",  "CUT2D",    "CUT2DF",   "NORM",    "KONT",      "KONTC",   "KONTT",
      "CFC",    "CFTCP",    "CFIN",      "DIAMOF",   "RTLION",   "RTLIOF",  "STOPRE",    "WALIMON", "WALIMOF",
      "ORIWKS", "ORIMKS",   "STARTFIFO", "STOPFIFO", "FIFOCTRL", "UPATH",   "SPATH",     "SAVE",    "DISPLOF",
      "SPCON",  "SPCOF",    "CPRECON",   "CPRECOF",  "G60",      "TRAFOOF", "EXTCALLOFF"};
  return kWords;
}

const std::set<std::string>& calls_without_effect() {
  static const std::set<std::string> kCalls = {"MSG",       "SETAL",  "WORKPIECE", "CYCLE832", "GROUP_BEGIN",
                                               "GROUP_END", "FGROUP", "SETMS",     "STOPRE"};
  return kCalls;
}

/// G codes without effect on times and speeds.
bool is_without_effect(int g) {
  static const std::set<int> kCodes = {9,   60,  64,  601, 602, 603, 641, 642, 643, 644, 645,
                                       450, 451, 460, 461, 462, 621, 622, 97,  25,  26};
  return kCodes.contains(g);
}

const char* hint_of(int g) {
  switch (g) {
    case 20:
    case 21:
      return "this control's inch and mm are G70 and G71, or G700 and G710; programs in ISO code begin with G291";
    case 28:
    case 30:
    case 43:
    case 49:
    case 80:
    case 81:
    case 82:
    case 83:
    case 98:
    case 99:
      return "this is a word of ISO code, which this control knows only after G291";
    case 33:
    case 34:
    case 35:
      return "threading is not computed here; write G1 with G95";
    case 96:
    case 961:
      return "constant surface speed is not computed here; write the spindle speeds with G97";
    case 110:
    case 111:
    case 112:
      return "polar coordinates are not computed here; let the post-processor write X, Y, Z";
    case 147:
    case 148:
    case 247:
    case 248:
    case 347:
    case 348:
      return "soft approach and retraction are not computed here; let the post-processor write them out";
    case 291:
      return "a change to ISO code within a program is not followed; write it in the first block";
    default:
      return "its effect on times and speeds is not known here; if it has none, name it under `ignore`";
  }
}

struct Repetition {
  std::size_t first = 0, last = 0;  ///< lines, both included
  int left = 0;
  std::size_t back = 0;  ///< line at which it continues
};

class SiemensReader {
 public:
  SiemensReader(const std::string& path, const std::vector<std::string>& text, NcRun& run)
      : path_(path), run_(run), lines_(siemens_lines(path, text)) {}

  void run() {
    while (at_ < lines_.size()) {
      const SiemensLine& line = lines_[at_];
      run_.count(line.where);
      if (!statement(line) && !block(line)) return;
      end_repetitions();
    }
    throw InputError(fmt::format("{}: the program has no end; write M30, M2, M17 or RET as its last block", path_));
  }

 private:
  using Word = SiemensWord;

  [[noreturn]] static void fail(const SiemensLine& line, std::size_t column, const std::string& message) {
    Where where = line.where;
    where.column = static_cast<int>(column) + 1;
    throw InputError(where, message);
  }

  NcLookup lookup() {
    return [this](const std::string& name) -> NcValue {
      const auto found = variables_.find(name);
      if (found != variables_.end()) return {found->second};
      if (is_r_parameter(name))
        throw RangeError(
            fmt::format("{} is what the operator or another program has set; give it a value in the program first", name));
      throw RangeError(fmt::format("'{}' is known only at the machine or not at all", name));
    };
  }

  double value(const SiemensLine& line, const std::string& text, std::size_t& at) {
    try {
      return evaluate(text, at, NcSyntax::kSiemens, lookup(), true).value;
    } catch (const RangeError& e) {
      fail(line, at, e.what());
    }
  }
  double value_of(const SiemensLine& line, const Word& word) {
    std::size_t at = 0;
    try {
      const double x = evaluate(word.value, at, NcSyntax::kSiemens, lookup(), true).value;
      if (word.value.find_first_not_of(" \t", at) != std::string::npos)
        throw RangeError("the expression has more text after its end");
      return x;
    } catch (const RangeError& e) {
      fail(line, word.column + at, e.what());
    }
  }

  // --- order of execution
  // -------------------------------------------------------------------------------------------------------

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
    fail(line, column,
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
    if (word == "CASE") fail(line, line.begin, "CASE is not followed here; write IF and GOTOF");
    if (word == "PROC" || word == "EXTERN")
      fail(line, line.begin, "subprograms are not called here; let the post-processor write them out");
    if (word == "IF") {
      const bool met = value(line, line.text, i) != 0.0;
      while (i < line.text.size() && line.text[i] == ' ') ++i;
      if (i >= line.text.size()) {
        at_ = met ? at_ + 1 : line.partner + 1;
      } else if (!met) {
        std::size_t behind = i;
        if (!siemens_name(line.text, behind).starts_with("GOTO")) fail(line, i, "GOTOF, GOTOB or GOTO is expected after IF");
        ++at_;
      } else if (!jump(line, i)) {
        fail(line, i, "GOTOF, GOTOB or GOTO is expected after IF");
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
      fail(line, line.begin, "of variables only REAL, INT and BOOL are followed here");
    while (true) {
      const std::string name = siemens_name(line.text, i);
      if (name.empty()) fail(line, i, "a name is expected here");
      double initial = 0.0;
      while (i < line.text.size() && line.text[i] == ' ') ++i;
      if (i < line.text.size() && line.text[i] == '=') initial = value(line, line.text, ++i);
      variables_[name] = initial;
      while (i < line.text.size() && line.text[i] == ' ') ++i;
      if (i >= line.text.size()) break;
      if (line.text[i++] != ',') fail(line, i - 1, "',' or the end of the line is expected here");
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
    if (i >= line.text.size() || line.text[i] != '=') fail(line, i, "a loop such as FOR R1=1 TO 5 is expected");
    const std::size_t to = line.text.find(" TO ", i);
    if (to == std::string::npos) fail(line, i, "a loop such as FOR R1=1 TO 5 is expected");
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
        if (!(n >= 0.0 && n <= kMostRuns && n == std::floor(n))) fail(line, i, fmt::format("P={:g} must be a count", n));
        times = static_cast<int>(n);
        continue;
      }
      const std::size_t column = i;
      labels.push_back(siemens_name(line.text, i));
      if (labels.back().empty()) fail(line, column, "a label is expected here");
    }
    if (labels.empty() || labels.size() > 2) fail(line, line.begin, "REPEAT requires one label or two");
    const std::size_t first = place_of(line, labels[0], line.begin, 0);
    std::size_t last = at_ - 1;
    if (labels.size() == 2) last = place_of(line, labels[1], line.begin, 0);
    if (one_block) last = first;
    if (labels.size() == 1 && !one_block && first > at_) {  // up to ENDLABEL
      last = first;
      while (last + 1 < lines_.size() && lines_[last].label != "ENDLABEL") ++last;
    }
    if (last < first || (first <= at_ && at_ <= last))
      fail(line, line.begin, "REPEAT must not repeat lines that contain it");
    if (times == 0) {
      ++at_;
      return;
    }
    if (repetitions_.size() >= 100) fail(line, line.begin, "repetitions are nested more than 100 deep");
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

  // --- one block
  // ----------------------------------------------------------------------------------------------------------------

  struct Block {
    const SiemensLine* line = nullptr;
    std::vector<int> g = {};
    std::vector<int> m = {};
    std::map<std::string, const Word*> words = {};  ///< X, Y, I, CR, F ...
    bool in_machine = false;
  };

  /// @returns true  if the program continues
  bool block(const SiemensLine& line) {
    ++at_;
    const std::vector<Word> words = siemens_words(line);
    if (words.empty()) return true;
    run_.begin(line.where, line.deletable);
    Block b{.line = &line};
    NcStep& step = run_.step();
    step.plain = true;
    bool ends = false;
    std::string frame;
    for (const Word& word : words) {
      if (run_.settings().ignored.contains(word.name + (word.kind == Word::kNumber ? word.value : ""))) {
        step.plain = false;
        continue;
      }
      step.plain = step.plain && word.kind == Word::kNumber &&
                   (std::string("XYZF").find(word.name) != std::string::npos ||
                    (word.name == "G" && (word.number() == 0.0 || word.number() == 1.0)));
      switch (word.kind) {
        case Word::kCall:
          call(line, word);
          break;
        case Word::kKeyword:
          ends = keyword(line, word, b, frame) || ends;
          break;
        default:
          address(line, word, b);
      }
    }
    if (!frame.empty()) shift(b, frame);
    if (const auto f = b.words.find("F"); f != b.words.end()) step.feed_word = f->second->text;
    ends = do_block(b) || ends;
    step.ends_program = ends;
    run_.end();
    return !ends;
  }

  void address(const SiemensLine& line, const Word& word, Block& b) {
    const std::string& name = word.name;
    if (is_r_parameter(name) || variables_.contains(name)) {
      variables_[name] = value_of(line, word);
      return;
    }
    if (name == "G") {
      b.g.push_back(whole(line, word));
    } else if (name == "M" || name == "M1") {
      b.m.push_back(whole(line, word));
    } else if (name == "O") {
      fail(line, word.column, "O numbers belong to ISO code, which begins with G291");
    } else if (name == "L" || name == "P") {
      fail(line, word.column,
           fmt::format("{}: subprograms are not called here; let the post-processor write them out", word.text));
    } else if (name == "T" || name == "T1") {
      b.words["T"] = &word;
    } else if (name == "A" || name == "B" || name == "C" || name == "U" || name == "V" || name == "W") {
      fail(line, word.column,
           fmt::format("{}: rotary and further linear axes are not followed here; X, Y, Z are", word.text));
    } else if (!b.words.emplace(name == "S1" ? "S" : name, &word).second) {
      fail(line, word.column, fmt::format("{}: a second {} in one block is not allowed", word.text, name));
    }
  }

  int whole(const SiemensLine& line, const Word& word) {
    const double x = value_of(line, word);
    if (!(x >= 0.0 && x < 100000.0 && x == std::floor(x)))
      fail(line, word.column, fmt::format("{}: there is no such word", word.text));
    return static_cast<int>(x);
  }

  /// @returns true  if it ends the program
  bool keyword(const SiemensLine& line, const Word& word, Block& b, std::string& frame) {
    const std::string& name = word.name;
    if (name == "RET") return true;
    if (name == "SUPA") {
      b.in_machine = true;
    } else if (name == "MCALL") {
      modal_cycle_.reset();
      run_.modal_cycle = false;
    } else if (std::set<std::string>{"TRANS", "ATRANS", "ROT", "AROT", "ROTS", "AROTS", "MIRROR", "AMIRROR", "SCALE",
                                     "ASCALE"}
                   .contains(name)) {
      if (!frame.empty()) fail(line, word.column, fmt::format("{} is not allowed beside {} in one block", name, frame));
      frame = name;
    } else if (name == "CIP" || name == "CT") {
      fail(line, word.column, fmt::format("{}: of arcs only G2 and G3 are computed here", name));
    } else if (std::set<std::string>{"TRAORI", "TRACYL", "TRANSMIT", "ORIAXES", "ASPLINE", "BSPLINE", "CSPLINE", "POLY"}
                   .contains(name)) {
      fail(line, word.column, fmt::format("{}: transformations and splines are not computed here", name));
    } else if (!keywords_without_effect().contains(name)) {
      fail(line, word.column,
           fmt::format(
               "{} is not known here, or is a subprogram, which is not called; if it has no effect on times and speeds, "
               "name it under `ignore`",
               name));
    }
    return false;
  }

  // --- interpretation
  // -----------------------------------------------------------------------------------------------------------

  [[nodiscard]] static bool has(const Block& b, const char* name) { return b.words.contains(name); }
  double number(const Block& b, const char* name) { return value_of(*b.line, *b.words.at(name)); }
  double not_negative(const Block& b, const char* name) {
    const double x = number(b, name);
    if (x < 0.0)
      fail(*b.line, b.words.at(name)->column, fmt::format("{}: the value must be zero or above", b.words.at(name)->text));
    return x;
  }
  int count(const Block& b, const char* name) {
    const double x = number(b, name);
    if (!(x >= 0.0 && x <= 1e5 && x == std::floor(x)))
      fail(*b.line, b.words.at(name)->column,
           fmt::format("{}: the value must be a whole number from 0 to 100000", b.words.at(name)->text));
    return static_cast<int>(x);
  }
  static bool contains(const std::vector<int>& codes, int code) {
    return std::find(codes.begin(), codes.end(), code) != codes.end();
  }

  /// @returns true  if it ends the program
  bool do_block(const Block& b) {
    NcStep& step = run_.step();
    bool dwell = false, motion_named = false;
    std::optional<int> tap, reference;
    for (const int g : b.g) {
      if (g <= 3) {
        motion_named = true;
        run_.motion_word = 10 * g;
      } else if (g == 63) {  // tapping with a floating chuck: a feed move that the spindle follows
        motion_named = true;
        run_.motion_word = 10;
      } else if (g == 331 || g == 332) {
        tap = g;
      } else if (g == 4) {
        dwell = true;
      } else if (g >= 17 && g <= 19) {
        run_.normal = 19 - g;
      } else if (g == 40) {
        run_.compensated = false;
      } else if (g == 41 || g == 42) {
        run_.compensated = true;
        run_.note(fmt::format("G{}", g),
                  "cutter compensation is not followed; the path is counted along the programmed contour");
      } else if (g == 53 || g == 153) {
        step.kind = NcStepKind::kMachine;
      } else if ((g >= 54 && g <= 59) || g == 500 || (g >= 505 && g <= 599)) {
        work_offset(g);
      } else if (g == 70 || g == 71 || g == 700 || g == 710) {
        step.unit_word = true;
        run_.unit_m = g == 70 || g == 700 ? kInch_m : kMillimetre_m;
        run_.feed_unit_m = g == 700 ? kInch_m : kMillimetre_m;
      } else if (g == 74 || g == 75) {
        reference = g;
      } else if (g == 90 || g == 91) {
        run_.absolute = g == 90;
      } else if (g >= 93 && g <= 95) {
        run_.set_feed_mode(g == 93 ? NcFeedMode::InverseTime : g == 94 ? NcFeedMode::PerMinute : NcFeedMode::PerRevolution);
      } else if (g == 290) {
        continue;
      } else if (!is_without_effect(g)) {
        run_.fail(fmt::format("G{}: {}", g, hint_of(g)));
      }
    }
    step.motion_word = motion_named;
    if (has(b, "D")) run_.forget();
    if (has(b, "F") && !dwell) run_.set_feed(not_negative(b, "F"));
    const bool limits = contains(b.g, 25) || contains(b.g, 26);
    if (has(b, "S") && !dwell && !limits) run_.motion.programmed_rpm = not_negative(b, "S");
    const bool ends = m_words(b);
    if (dwell) {
      wait(b);
    } else if (tap) {
      tap_thread(b, *tap);
    } else if (reference) {
      go_to_reference(b, *reference);
    } else if (!limits && !shifted_) {
      move(b);
    }
    shifted_ = false;
    reject_unused(b);
    if (run_.motion.feed_mode == NcFeedMode::InverseTime) run_.motion.feed = 0.0;
    return ends;
  }

  void reject_unused(const Block& b) {
    static const std::set<std::string> kKnown = {"X",       "Y",    "Z",   "I",    "J",   "K",    "CR",  "TURN", "F",
                                                 "FB",      "S",    "T",   "D",    "H",   "SPOS", "RPL", "X1",   "Y1",
                                                 "Z1",      "LIMS", "RND", "RNDM", "CHF", "CHR",  "FRC", "FRCM", "ADIS",
                                                 "ADISPOS", "OVR",  "ACC", "CTOL", "FAD", "DL"};
    for (const auto& [name, word] : b.words) {
      if (kKnown.contains(name)) continue;
      if ((name[0] == 'S' || name[0] == 'M' || name[0] == 'H') && name.size() > 1 &&
          std::isdigit(static_cast<unsigned char>(name[1])) != 0) {
        run_.note(word->text, "this is another spindle than the first; it is not followed");
        continue;
      }
      if (name == "AP" || name == "RP")
        fail(*b.line, word->column, fmt::format("{}: polar coordinates are not computed here", word->text));
      fail(*b.line, word->column,
           fmt::format("{}: this word is not known here; if it has no effect on times and speeds, name it under `ignore`",
                       word->text));
    }
    for (const char* corner : {"RND", "RNDM", "CHF", "CHR"}) {
      if (has(b, corner)) run_.note(corner, "corners are counted as programmed, not as rounded or broken");
    }
  }

  /// @returns true  if one ends the program
  bool m_words(const Block& b) {
    bool ends = false;
    for (const int m : b.m) {
      if (m == 6) run_.change_tool("M6");
    }
    for (const int m : b.m) {
      if (run_.settings().ignored.contains(fmt::format("M{}", m)) || m == 6) continue;
      if (m == 0 || m == 1) {
        run_.halt(fmt::format("M{}", m));
      } else if (m == 2 || m == 17 || m == 30) {
        ends = true;
      } else if (m == 3 || m == 4) {
        run_.motion.turning = true;
      } else if (m == 5 || m == 19 || m == 70) {
        run_.motion.turning = false;
      } else if (!(m >= 7 && m <= 9) && !(m >= 40 && m <= 45)) {
        run_.pass_over(fmt::format("M{}", m));
      }
    }
    if (has(b, "SPOS")) {
      (void)number(b, "SPOS");
      run_.motion.turning = false;
    }
    return ends;
  }

  void work_offset(int g) {
    NcStep& step = run_.step();
    if (g == 58 || g == 59)
      run_.fail(fmt::format("G{}: this shift of the origin is not followed here; write TRANS or ATRANS", g));
    step.system = 10 * g;
    step.resets = {true, true, true};
    if (system_ && *system_ != g)
      run_.note(fmt::format("G{}", g), "this is another work offset; positions are counted as if in the one before");
    system_ = g;
    run_.forget();
  }

  void wait(const Block& b) {
    if (has(b, "F")) {
      run_.motion.wait(not_negative(b, "F"));
    } else if (has(b, "S")) {
      const double rpm = run_.motion.speed_rpm();
      if (!(rpm > 0.0)) run_.fail("G4 S counts turns of the spindle, but the spindle is at rest");
      run_.motion.wait(not_negative(b, "S") * 60.0 / rpm);
    } else {
      run_.fail("G4 has no time; write F in seconds or S in turns of the spindle");
    }
  }

  /// TRANS X Y Z and similar words, in a separate block.
  void shift(const Block& b, const std::string& frame) {
    shifted_ = true;
    run_.step().plain = false;
    const bool additive = frame[0] == 'A';
    const std::string kind = additive ? frame.substr(1) : frame;
    bool any = has(b, "RPL");
    std::array<double, 3> to_m = additive ? shift_m_ : std::array<double, 3>{0, 0, 0};
    for (int axis = 0; axis < 3; ++axis) {
      const std::string name(1, static_cast<char>('X' + axis));
      if (!has(b, name.c_str())) continue;
      any = true;
      const double x = number(b, name.c_str());
      if (kind == "TRANS") to_m[axis] += x * run_.unit_m;
      if (kind == "SCALE" && x != 1.0)
        run_.fail("scaling is not computed here; let the post-processor write lengths as they are");
    }
    if (run_.compensated) run_.fail(fmt::format("{} is not allowed with G41 or G42 on", frame));
    const bool was_transformed = run_.transformed;
    if (!additive) run_.transformed = false;  // TRANS, ROT, MIRROR remove all frames programmed before
    if (any && (kind == "ROT" || kind == "ROTS" || kind == "MIRROR")) {
      run_.transformed = true;
      run_.note(frame, "the path is counted as written, and no correction changes while it is in force");
    }
    if (kind != "TRANS" && additive) to_m = shift_m_;
    for (int axis = 0; axis < 3; ++axis) run_.motion.position_m[axis] += shift_m_[axis] - to_m[axis];
    shift_m_ = to_m;
    if (was_transformed || run_.transformed) run_.forget();
  }

  std::array<double, 3> target(const Block& b) {
    std::array<double, 3> target_m = run_.motion.position_m;
    NcStep& step = run_.step();
    for (int axis = 0; axis < 3; ++axis) {
      const auto found = b.words.find(std::string(1, static_cast<char>('X' + axis)));
      if (found == b.words.end()) continue;
      const double x_m = value_of(*b.line, *found->second) * run_.unit_m;
      const bool absolute = found->second->mode.empty() ? run_.absolute : found->second->mode == "AC";
      step.named[axis] = true;
      step.absolute = step.absolute && absolute;
      target_m[axis] = absolute ? x_m : target_m[axis] + x_m;
    }
    return target_m;
  }

  void go_to_reference(const Block& b, int g) {
    const std::array<double, 3>& zero_m = run_.machine_zero(fmt::format("G{}", g));
    std::array<double, 3> target_m = run_.motion.position_m;
    NcStep& step = run_.step();
    for (int axis = 0; axis < 3; ++axis) {
      const char letter = static_cast<char>('X' + axis);
      if (!has(b, std::string(1, letter).c_str()) && !has(b, fmt::format("{}1", letter).c_str())) continue;
      step.named[axis] = true;
      target_m[axis] = zero_m[axis];
    }
    run_.rapid_to(target_m);
    step.kind = NcStepKind::kMachine;
  }

  void move(const Block& b) {
    NcStep& step = run_.step();
    const bool machine = b.in_machine || step.kind == NcStepKind::kMachine;
    step.kind = NcStepKind::kNone;
    const bool arc = run_.motion_word == 20 || run_.motion_word == 30;
    const bool axes = has(b, "X") || has(b, "Y") || has(b, "Z");
    const bool centre = has(b, "I") || has(b, "J") || has(b, "K") || has(b, "CR");
    if (!axes && !(arc && centre)) {
      if (machine) run_.fail("SUPA, G53 or G153 has no straight move; write X, Y or Z with it");
      return;
    }
    if (!run_.motion_word) run_.motion_word = 10;  // the control's default after a start
    if (machine) {
      if (arc) run_.fail("SUPA, G53 and G153 are allowed only with G0 and G1");
      const std::array<double, 3>& zero_m = run_.machine_zero("SUPA");
      std::array<double, 3> target_m = run_.motion.position_m;
      for (int axis = 0; axis < 3; ++axis) {
        const std::string name(1, static_cast<char>('X' + axis));
        if (!has(b, name.c_str())) continue;
        step.named[axis] = true;
        target_m[axis] = zero_m[axis] + number(b, name.c_str()) * run_.unit_m;
      }
      run_.motion_word == 0 ? run_.rapid_to(target_m) : run_.feed_to(target_m);
      step.kind = NcStepKind::kMachine;
      return;
    }
    const double modal_feed = run_.motion.feed;
    if (has(b, "FB")) run_.set_feed(not_negative(b, "FB"));
    if (run_.motion_word == 0) {
      run_.rapid_to(target(b));
    } else if (arc) {
      move_along_arc(b);
    } else {
      run_.feed_to(target(b));
    }
    if (has(b, "FB")) run_.motion.feed = modal_feed;
    if (modal_cycle_) {
      drill(*modal_cycle_);
      step.kind = NcStepKind::kDrilling;
    }
  }

  void move_along_arc(const Block& b) {
    const bool clockwise = run_.motion_word == 20;
    const auto [u, v] = plane_axes(run_.normal);
    const std::array<double, 3> target_m = target(b);
    const int turns = has(b, "TURN") ? 1 + count(b, "TURN") : 1;
    std::array<double, 3> centre_m = run_.motion.position_m;
    if (has(b, "CR")) {
      centre_m = run_.centre_of(target_m, number(b, "CR") * run_.unit_m, clockwise);
    } else {
      int n = 0;
      for (const int axis : {u, v}) {
        const auto found = b.words.find(std::string(1, static_cast<char>('I' + axis)));
        if (found == b.words.end()) continue;
        ++n;
        const double x_m = value_of(*b.line, *found->second) * run_.unit_m;
        centre_m[axis] = found->second->mode == "AC" ? x_m : run_.motion.position_m[axis] + x_m;
      }
      if (n == 0) run_.fail("the arc has no centre; write I, J, K of the plane or CR=");
    }
    run_.arc_to(target_m, centre_m, clockwise, turns);
  }

  void tap_thread(const Block& b, int g) {
    const char* pitch_name = run_.normal == 2 ? "K" : run_.normal == 1 ? "J" : "I";
    if (!has(b, pitch_name)) run_.fail(fmt::format("G{} has no pitch {}", g, pitch_name));
    tap_to(run_, target(b), std::abs(number(b, pitch_name)) * run_.unit_m, run_.motion.programmed_rpm);
    run_.step().motion_word = true;
    run_.step().no_place = true;  // the thread depends on the spindle's angle
    run_.motion_word = 10;
  }

  // --- drilling cycles
  // ----------------------------------------------------------------------------------------------------------

  struct Cycle {
    int code = 81;
    std::vector<std::optional<double>> p;
  };

  void call(const SiemensLine& line, const Word& word) {
    run_.step().plain = false;
    const std::string& name = word.name;
    if (calls_without_effect().contains(name)) return;
    const bool modal = name.starts_with("MCALL ");
    const std::string cycle = modal ? name.substr(6) : name;
    if (cycle == "CYCLE800") {
      run_.transformed = word.value.find_first_not_of(" ,0") != std::string::npos;
      run_.forget();
      if (run_.transformed)
        run_.note("CYCLE800",
                  "this swivels the plane; the path is counted as written, and no correction changes while it is in force");
      return;
    }
    static const std::map<std::string, int> kCycles = {
        {"CYCLE81", 81}, {"CYCLE82", 82}, {"CYCLE83", 83}, {"CYCLE84", 84}, {"CYCLE85", 85}};
    const auto found = kCycles.find(cycle);
    if (found == kCycles.end())
      fail(line, word.column,
           fmt::format(
               "{}( ): of cycles only CYCLE81 to CYCLE85 are computed here; let the post-processor write the others out, "
               "or name one without effect under `ignore`",
               cycle));
    Cycle c{.code = found->second, .p = {}};
    for (const auto& [text, column] : siemens_arguments(word)) {
      if (text.find_first_not_of(" \t") == std::string::npos) {
        c.p.emplace_back();
        continue;
      }
      std::size_t at = 0;
      try {
        c.p.emplace_back(evaluate(text, at, NcSyntax::kSiemens, lookup(), true).value);
      } catch (const RangeError& e) {
        fail(line, column + at, e.what());
      }
    }
    if (modal) {
      modal_cycle_ = c;
      run_.modal_cycle = true;
      return;
    }
    drill(c);
    run_.step().kind = NcStepKind::kDrilling;
    run_.step().named[run_.normal] = true;
  }

  static std::optional<double> of(const Cycle& c, std::size_t i) { return i < c.p.size() ? c.p[i] : std::nullopt; }

  /// The drill moves down along the axis normal to the plane, from its present position.
  void drill(const Cycle& c) {
    const auto need = [&](std::size_t i, const char* name) {
      const auto x = of(c, i);
      if (!x) run_.fail(fmt::format("CYCLE{} has no {}", c.code, name));
      return *x * run_.unit_m;
    };
    const double retract_m = need(0, "retraction plane RTP"), reference_m = need(1, "reference plane RFP"),
                 safe_m = reference_m + std::abs(of(c, 2).value_or(0.0)) * run_.unit_m;
    if (!of(c, 3) && !of(c, 4)) run_.fail(fmt::format("CYCLE{} has no depth DP or DPR", c.code));
    const double bottom_m = of(c, 3) ? *of(c, 3) * run_.unit_m : reference_m - std::abs(*of(c, 4)) * run_.unit_m;
    if (!(bottom_m <= safe_m && retract_m >= bottom_m))
      run_.fail(fmt::format("the depth of CYCLE{} lies above its planes; drilling goes downward", c.code));
    NcMotion& motion = run_.motion;
    const auto at = [&](double level_m) {
      std::array<double, 3> target_m = motion.position_m;
      target_m[run_.normal] = level_m;
      return target_m;
    };
    motion.rapid_to(at(safe_m));
    switch (c.code) {
      case 83:
        peck(c, reference_m, safe_m, bottom_m, at);
        break;
      case 84: {
        const double pitch_m = std::abs(of(c, 8).value_or(0.0)) * run_.unit_m;
        if (!(pitch_m > 0.0)) run_.fail("CYCLE84 has no pitch PIT; threads by size (MPIT) are not looked up here");
        const double in_rpm = of(c, 10).value_or(0.0) > 0.0 ? *of(c, 10) : motion.programmed_rpm;
        tap_to(run_, at(bottom_m), pitch_m, in_rpm);
        motion.wait(of(c, 5).value_or(0.0));
        tap_to(run_, at(safe_m), pitch_m, of(c, 11).value_or(0.0) > 0.0 ? *of(c, 11) : in_rpm);
        motion.turning = false;
        break;
      }
      case 85: {
        const double modal_feed = motion.feed;
        if (of(c, 6).value_or(0.0) > 0.0) run_.set_feed(*of(c, 6));
        motion.feed_to(at(bottom_m));
        motion.wait(of(c, 5).value_or(0.0));
        if (of(c, 7).value_or(0.0) > 0.0) run_.set_feed(*of(c, 7));
        motion.feed_to(at(safe_m));
        motion.feed = modal_feed;
        break;
      }
      default:
        motion.feed_to(at(bottom_m));
        if (c.code == 82) motion.wait(of(c, 5).value_or(0.0));
    }
    motion.rapid_to(at(retract_m));
  }

  /// CYCLE83(RTP, RFP, SDIS, DP, DPR, FDEP, FDPR, DAM, DTB, DTS, FRF, VARI): each depth is smaller by DAM than the previous,
  /// but at least DAM.
  template <class At>
  void peck(const Cycle& c, double reference_m, double safe_m, double bottom_m, const At& at) {
    NcMotion& motion = run_.motion;
    double depth_m = reference_m;
    if (of(c, 5)) {
      depth_m = *of(c, 5) * run_.unit_m;
    } else if (of(c, 6)) {
      depth_m = reference_m - std::abs(*of(c, 6)) * run_.unit_m;
    } else {
      run_.fail("CYCLE83 has no first depth FDEP or FDPR");
    }
    const double degression = of(c, 7).value_or(0.0);
    double bite_m = reference_m - depth_m;
    if (!(bite_m > 0.0 && (reference_m - bottom_m) / bite_m < 1e5))
      run_.fail("the first depth of CYCLE83 must be below its reference plane");
    const bool clears = of(c, 11).value_or(0.0) != 0.0;
    const double modal_feed = motion.feed;
    if (of(c, 10).value_or(0.0) > 0.0) motion.feed *= *of(c, 10);
    for (int n = 0; n < 100000; ++n) {
      depth_m = std::max(depth_m, bottom_m);
      motion.feed_to(at(depth_m));
      motion.feed = modal_feed;
      motion.wait(of(c, 8).value_or(0.0));
      if (depth_m <= bottom_m) return;
      if (clears) {  // to the safe level, and back to 0.6 mm above the depth reached (for 30 mm and less)
        motion.rapid_to(at(safe_m));
        motion.wait(of(c, 9).value_or(0.0));
        const double hole_m = reference_m - bottom_m;
        motion.rapid_to(at(depth_m + (hole_m <= 0.030 ? 0.6e-3 : hole_m / 50.0)));
      } else {
        motion.feed_to(at(depth_m + 1e-3));  // breaks the chip
      }
      const double least_m = degression < 0.0 ? 0.0 : degression * run_.unit_m;
      const double next_m = degression < 0.0 ? bite_m * -degression : bite_m - least_m;
      bite_m = degression > 0.0 ? std::max(next_m, std::min(bite_m, least_m)) : degression < 0.0 ? next_m : bite_m;
      if (!(bite_m > 1e-6)) run_.fail("the depths of CYCLE83 shrink to nothing");
      depth_m -= bite_m;
    }
    run_.fail("CYCLE83 has more than 100000 pecks");
  }

  std::string path_;
  NcRun& run_;
  std::vector<SiemensLine> lines_;
  std::size_t at_ = 0;
  std::map<std::string, double> variables_;
  std::vector<Repetition> repetitions_;
  std::optional<Cycle> modal_cycle_;
  std::optional<int> system_;
  std::array<double, 3> shift_m_ = {0, 0, 0};
  bool shifted_ = false;
};

}  // namespace

bool asks_for_iso_mode(const std::vector<std::string>& lines) {
  for (std::string line : lines) {
    line.erase(std::min(line.find(';'), line.size()));
    line.erase(std::min(line.find('('), line.size()));
    for (char& c : line) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (line.find("G291") != std::string::npos) return true;
    if (line.find('X') != std::string::npos || line.find('Z') != std::string::npos) return false;
  }
  return false;
}

void run_siemens_program(const std::string& path, const std::vector<std::string>& lines, NcRun& run) {
  SiemensReader(path, lines, run).run();
}

}  // namespace driftwright
