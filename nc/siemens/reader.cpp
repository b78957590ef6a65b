// One reader of one language: its modes are the state that each word changes; cycles and words have files of their own.
#include "nc/siemens/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "nc/arc.hpp"
#include "nc/siemens/cycles.hpp"
#include "nc/siemens/source.hpp"
#include "nc/siemens/words.hpp"
#include "nc/tapping.hpp"
#include "nc/units.hpp"
#include "nc/words.hpp"

namespace driftwright {
namespace {

class SiemensReader {
 public:
  SiemensReader(const std::string& path, const std::vector<std::string>& text, NcExecution& run)
      : path_(path), run_(run), source_(path, text, run) {}

  void run() {
    while (const SiemensLine* line = source_.next()) {
      if (!block(*line)) return;
    }
    throw InputError(fmt::format("{}: the program has no end; write M30, M2, M17 or RET as its last block", path_));
  }

 private:
  using Word = SiemensWord;

  double value_of(const SiemensLine& line, const Word& word) const {
    return source_.value_of(line, word.value, word.column, true);
  }

  struct Block {
    const SiemensLine* line = nullptr;
    std::vector<int> g = {};
    std::vector<int> m = {};
    std::map<std::string, const Word*> words = {};  ///< X, Y, I, CR, F ...
    bool in_machine = false;
  };

  /// @returns true  if the program continues
  bool block(const SiemensLine& line) {
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
    if (source_.is_variable(name)) {
      source_.set_variable(name, value_of(line, word));
      return;
    }
    if (name == "G") {
      b.g.push_back(whole(line, word));
    } else if (name == "M" || name == "M1") {
      b.m.push_back(whole(line, word));
    } else if (name == "O") {
      fail_at(line, word.column, "O numbers belong to ISO code, which begins with G291");
    } else if (name == "L" || name == "P") {
      fail_at(line, word.column,
              fmt::format("{}: subprograms are not called here; let the post-processor write them out", word.text));
    } else if (name == "T" || name == "T1") {
      b.words["T"] = &word;
    } else if (name == "A" || name == "B" || name == "C" || name == "U" || name == "V" || name == "W") {
      fail_at(line, word.column,
              fmt::format("{}: rotary and further linear axes are not followed here; X, Y, Z are", word.text));
    } else if (!b.words.emplace(name == "S1" ? "S" : name, &word).second) {
      fail_at(line, word.column, fmt::format("{}: a second {} in one block is not allowed", word.text, name));
    }
  }

  int whole(const SiemensLine& line, const Word& word) {
    const double x = value_of(line, word);
    if (!(x >= 0.0 && x < 100000.0 && x == std::floor(x)))
      fail_at(line, word.column, fmt::format("{}: there is no such word", word.text));
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
      if (!frame.empty()) fail_at(line, word.column, fmt::format("{} is not allowed beside {} in one block", name, frame));
      frame = name;
    } else if (name == "CIP" || name == "CT") {
      fail_at(line, word.column, fmt::format("{}: of arcs only G2 and G3 are computed here", name));
    } else if (std::set<std::string>{"TRAORI", "TRACYL", "TRANSMIT", "ORIAXES", "ASPLINE", "BSPLINE", "CSPLINE", "POLY"}
                   .contains(name)) {
      fail_at(line, word.column, fmt::format("{}: transformations and splines are not computed here", name));
    } else if (!is_siemens_keyword_without_effect(name)) {
      fail_at(line, word.column,
              fmt::format(
                  "{} is not known here, or is a subprogram, which is not called; if it has no effect on times and speeds, "
                  "name it under `ignore`",
                  name));
    }
    return false;
  }

  // --- interpretation

  [[nodiscard]] static bool has(const Block& b, const char* name) { return b.words.contains(name); }
  double number(const Block& b, const char* name) { return value_of(*b.line, *b.words.at(name)); }
  double not_negative(const Block& b, const char* name) {
    const double x = number(b, name);
    if (x < 0.0)
      fail_at(*b.line, b.words.at(name)->column, fmt::format("{}: the value must be zero or above", b.words.at(name)->text));
    return x;
  }
  int count(const Block& b, const char* name) {
    const double x = number(b, name);
    if (!(x >= 0.0 && x <= 1e5 && x == std::floor(x)))
      fail_at(*b.line, b.words.at(name)->column,
              fmt::format("{}: the value must be a whole number from 0 to 100000", b.words.at(name)->text));
    return static_cast<int>(x);
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
      } else if (!is_siemens_g_without_effect(g)) {
        run_.fail(fmt::format("G{}: {}", g, siemens_g_hint(g)));
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
        fail_at(*b.line, word->column, fmt::format("{}: polar coordinates are not computed here", word->text));
      fail_at(*b.line, word->column,
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
      run_siemens_cycle(run_, *modal_cycle_);
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

  void call(const SiemensLine& line, const Word& word) {
    run_.step().plain = false;
    const std::string& name = word.name;
    if (is_siemens_call_without_effect(name)) return;
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
    const std::optional<int> code = siemens_cycle_code(cycle);
    if (!code)
      fail_at(line, word.column,
              fmt::format(
                  "{}( ): of cycles only CYCLE81 to CYCLE85 are computed here; let the post-processor write the others out, "
                  "or name one without effect under `ignore`",
                  cycle));
    SiemensCycle called{.code = *code, .p = {}};
    for (const auto& [text, column] : siemens_arguments(word)) {
      const bool is_given = text.find_first_not_of(" \t") != std::string::npos;
      called.p.push_back(is_given ? std::optional(source_.value_of(line, text, column, false)) : std::nullopt);
    }
    if (modal) {
      modal_cycle_ = called;
      run_.modal_cycle = true;
      return;
    }
    run_siemens_cycle(run_, called);
    run_.step().kind = NcStepKind::kDrilling;
    run_.step().named[run_.normal] = true;
  }

  std::string path_;
  NcExecution& run_;
  SiemensSource source_;
  std::optional<SiemensCycle> modal_cycle_;
  std::optional<int> system_;
  std::array<double, 3> shift_m_ = {0, 0, 0};
  bool shifted_ = false;
};

}  // namespace

void run_siemens_program(const std::string& path, const std::vector<std::string>& lines, NcExecution& run) {
  SiemensReader(path, lines, run).run();
}

}  // namespace driftwright
