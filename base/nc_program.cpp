#include "base/nc_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/nc_arc.hpp"
#include "base/nc_block.hpp"
#include "base/nc_drilling.hpp"

namespace driftwright {
namespace {

constexpr double kInch_m = 0.0254, kMillimetre_m = 1e-3;

/// Codes of a word times ten: G5.1 is 51.
using Code = int;

const std::map<Code, const char*>& g_groups() {  // of one group, a block may name one
  static const std::map<Code, const char*> groups = [] {
    std::map<Code, const char*> g;
    const auto add = [&](const char* group, std::initializer_list<Code> codes) {
      for (Code c : codes) g[c] = group;
    };
    add("motion", {0, 10, 20, 30, 730, 800, 810, 820, 830, 840, 850});
    add("plane", {170, 180, 190});
    add("distance", {900, 910});
    add("arc centre", {901, 911});
    add("feed mode", {930, 940, 950});
    add("unit", {200, 210});
    add("cutter compensation", {400, 410, 420});
    add("tool length", {430, 490});
    add("retract", {980, 990});
    add("coordinate system", {540, 550, 560, 570, 580, 590, 591, 592, 593});
    add("path control", {610, 611, 640});
    add("spindle mode", {970});
    add("polar", {150});
    add("rotation", {690});
    add("reference point", {280, 300});
    add("dwell", {40});
    add("machine coordinates", {530});
    return g;
  }();
  return groups;
}

const std::map<Code, const char*>& m_groups() {
  static const std::map<Code, const char*> groups = {
      {0, "stop"},     {10, "stop"},    {20, "stop"},        {300, "stop"},     {600, "stop"},
      {30, "spindle"}, {40, "spindle"}, {50, "spindle"},     {190, "spindle"},  {60, "tool change"},
      {70, "mist"},    {80, "flood"},   {90, "coolant off"}, {480, "override"}, {490, "override"}};
  return groups;
}

const char* hint(char letter, Code code) {
  if (letter == 'G') {
    if (code >= 50 && code <= 53) return "splines are not computed here; let the CAM system write lines and arcs";
    if (code == 330 || code == 331 || code == 760) return "threading is not computed here; write G1 with G95";
    if (code == 100 || code == 520 || (code >= 920 && code <= 923))
      return "shifts of the origin are not followed here; write the program about one origin";
    if (code == 680 || code == 510 || code == 500 || code == 160)
      return "rotation, scaling and polar coordinates are not computed here";
    if (code == 960) return "constant surface speed is not computed here; write the spindle speeds with G97";
    if (code >= 382 && code <= 385) return "probing ends nobody knows when; leave it out";
    if (code == 650 || code == 660) return "macros are not run here; let the post-processor write them out";
    if (code == 740 || (code >= 860 && code <= 890))
      return "of the canned cycles G73, G81 to G85 are known; write the others out";
  }
  if (letter == 'M' && (code == 970 || code == 980 || code == 990))
    return "subprograms are not called here; let the post-processor write them out";
  return "its effect on times and speeds is not known here; if it has none, name it under `ignore`";
}

/// The words of a block, and which of them have been used.
class Words {
 public:
  explicit Words(const NcBlock& block) : block_(block), used_(block.words.size(), false) {
    for (std::size_t i = 0; i < block.words.size(); ++i) {
      const char letter = block.words[i].letter;
      if (letter == 'G' || letter == 'M') continue;
      for (std::size_t j = 0; j < i; ++j) {
        if (block.words[j].letter == letter) fail(i, fmt::format("a second {} in one block", letter));
      }
    }
  }

  [[noreturn]] void fail(std::size_t i, const std::string& message) const {
    throw InputError(block_.at(block_.words[i]), fmt::format("{}: {}", block_.words[i].text, message));
  }
  bool has(char letter) const { return find(letter) < used_.size(); }
  bool has_any(const char* letters) const {
    return std::any_of(letters, letters + std::char_traits<char>::length(letters), [&](char c) { return has(c); });
  }
  /// An unused word's value, now used.
  std::optional<double> take(char letter) {
    const std::size_t i = find(letter);
    if (i >= used_.size()) return std::nullopt;
    used_[i] = true;
    return block_.words[i].value;
  }
  double take_not_negative(char letter) {
    const std::size_t i = find(letter);
    const double value = *take(letter);
    if (value < 0.0) fail(i, "a value of zero or above is wanted");
    return value;
  }
  int take_count(char letter) {
    const std::size_t i = find(letter);
    const double value = *take(letter);
    if (!(value >= 1.0 && value <= 1e5 && value == std::floor(value))) fail(i, "a whole number from 1 to 100000 is wanted");
    return static_cast<int>(value);
  }
  /// G or M codes in their order, all used now; those of `ignored` are left out, and with them words P Q R L E.
  std::vector<Code> take_codes(char letter, const std::map<Code, const char*>& groups,
                               const std::set<std::string>& ignored) {
    std::vector<Code> codes;
    for (std::size_t i = 0; i < used_.size(); ++i) {
      if (block_.words[i].letter != letter) continue;
      const double tenths = 10.0 * block_.words[i].value;
      const Code code = static_cast<Code>(std::lround(std::clamp(tenths, -1.0, 1e6)));
      if (std::abs(tenths - code) > 1e-3 || code < 0) fail(i, "no such word");
      used_[i] = true;
      if (ignored.count(name(letter, code)) > 0) {
        pardoned_ = "PQRLE";
        continue;
      }
      const auto group = groups.find(code);
      if (group == groups.end()) fail(i, hint(letter, code));
      for (Code other : codes) {
        if (std::string(groups.at(other)) == group->second)
          fail(i, fmt::format("it contradicts {} in the same block (group: {})", name(letter, other), group->second));
      }
      codes.push_back(code);
    }
    return codes;
  }
  void reject_unused() const {
    for (std::size_t i = 0; i < used_.size(); ++i) {
      const char letter = block_.words[i].letter;
      if (used_[i] || pardoned_.find(letter) != std::string::npos) continue;
      if (std::string("ABCUVW").find(letter) != std::string::npos)
        fail(i, "rotary and further linear axes are not followed here; X, Y, Z are");
      fail(i, "this word has no use in its block");
    }
  }
  static std::string name(char letter, Code code) {
    return code % 10 == 0 ? fmt::format("{}{}", letter, code / 10) : fmt::format("{}{}.{}", letter, code / 10, code % 10);
  }

 private:
  std::size_t find(char letter) const {
    for (std::size_t i = 0; i < used_.size(); ++i) {
      if (!used_[i] && block_.words[i].letter == letter) return i;
    }
    return used_.size();
  }
  const NcBlock& block_;
  std::vector<bool> used_;
  std::string pardoned_;
};

bool contains(const std::vector<Code>& codes, Code code) {
  return std::find(codes.begin(), codes.end(), code) != codes.end();
}

/// The code of `group` among `codes`.
std::optional<Code> of_group(const std::vector<Code>& codes, const char* group) {
  for (Code c : codes) {
    if (std::string(g_groups().at(c)) == group) return c;
  }
  return std::nullopt;
}

bool is_drilling(std::optional<Code> motion) {
  return motion && *motion >= 730 && *motion != 800;
}

class Interpreter {
 public:
  explicit Interpreter(const NcSettings& settings) : settings_(settings), motion_(settings.rapid_m_s) {}

  /// @returns whether the program goes on
  bool run(const NcBlock& block) {
    motion_.where = block.where;
    if (block.words[0].letter == '%') return false;
    Words words(block);
    const std::vector<Code> g = words.take_codes('G', g_groups(), settings_.ignored);
    const std::vector<Code> m = words.take_codes('M', m_groups(), settings_.ignored);
    if (contains(g, 200)) unit_m_ = kInch_m;
    if (contains(g, 210)) unit_m_ = kMillimetre_m;
    set_feed(g, words);
    if (words.has('S')) motion_.programmed_rpm = words.take_not_negative('S');
    (void)words.take('T');
    set_spindle(m);
    if (contains(g, 40)) dwell(g, words);
    set_modes(g, words);
    if (const auto reference = of_group(g, "reference point")) go_to_reference(*reference, words);
    move(g, words);
    if (motion_.feed_mode == NcFeedMode::InverseTime) motion_.feed = 0.0;  // an F holds for its own block
    words.reject_unused();
    return !contains(m, 20) && !contains(m, 300);
  }

  NcProgram result() && { return {motion_.moves(), std::move(notes_)}; }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError(motion_.where, message); }

  void note(const std::string& word, const std::string& message) {
    if (noted_.insert(word).second) notes_.push_back(fmt::format("line {}: {}: {}", motion_.where.line, word, message));
  }

  void set_feed(const std::vector<Code>& g, Words& words) {
    const std::optional<Code> mode = of_group(g, "feed mode");
    if (mode) {
      const NcFeedMode wanted = *mode == 930   ? NcFeedMode::InverseTime
                                : *mode == 940 ? NcFeedMode::PerMinute
                                               : NcFeedMode::PerRevolution;
      if (wanted != motion_.feed_mode) motion_.feed = 0.0;
      motion_.feed_mode = wanted;
    }
    if (!words.has('F')) return;
    const double f = words.take_not_negative('F');
    switch (motion_.feed_mode) {
      case NcFeedMode::PerMinute:
        motion_.feed = f * unit_m_ / 60.0;
        break;
      case NcFeedMode::InverseTime:
        motion_.feed = f / 60.0;
        break;
      case NcFeedMode::PerRevolution:
        motion_.feed = f * unit_m_;
        break;
    }
  }

  void set_spindle(const std::vector<Code>& m) {
    if (contains(m, 60)) {
      if (!settings_.tool_change_s)
        fail("M6 changes the tool, but nobody says how long that takes; state `tool_change`, such as 8 s");
      motion_.turning = false;
      motion_.wait(*settings_.tool_change_s);
    }
    if (contains(m, 30) || contains(m, 40)) motion_.turning = true;
    if (contains(m, 50) || contains(m, 190)) motion_.turning = false;
  }

  void dwell(const std::vector<Code>& g, Words& words) {
    if (words.has('P')) {
      motion_.wait(words.take_not_negative('P') * settings_.dwell_P_s);
    } else if (!of_group(g, "motion") && words.has_any("XU")) {
      motion_.wait(words.take_not_negative(words.has('X') ? 'X' : 'U'));
    } else {
      fail("G4 without its time; P, or X or U in seconds, is wanted");
    }
  }

  void set_modes(const std::vector<Code>& g, Words& words) {
    if (contains(g, 170)) normal_ = 2;
    if (contains(g, 180)) normal_ = 1;
    if (contains(g, 190)) normal_ = 0;
    if (contains(g, 410) || contains(g, 420)) {
      (void)words.take('D');
      note(contains(g, 410) ? "G41" : "G42", "cutter compensation; the path is counted along the programmed contour");
    }
    if (contains(g, 430)) (void)words.take('H');
    if (contains(g, 400)) (void)words.take('D');
    if (contains(g, 490)) (void)words.take('H');
    if (const auto system = of_group(g, "coordinate system")) {
      if (system_ && *system_ != *system)
        note(Words::name('G', *system), "another coordinate system; positions are counted as if in the one before");
      system_ = system;
    }
    if (contains(g, 640)) {
      (void)words.take('P');
      (void)words.take('Q');
    }
    if (contains(g, 900)) absolute_ = true;
    if (contains(g, 910)) absolute_ = false;
    if (contains(g, 901)) absolute_centre_ = true;
    if (contains(g, 911)) absolute_centre_ = false;
    if (contains(g, 980)) to_initial_level_ = true;
    if (contains(g, 990)) to_initial_level_ = false;
  }

  /// Where the block's X, Y, Z point to; the axes it does not name stay.
  std::array<double, 3> take_target(Words& words, bool absolute) {
    std::array<double, 3> target_m = motion_.position_m;
    for (int axis = 0; axis < 3; ++axis) {
      if (const auto value = words.take(static_cast<char>('X' + axis)))
        target_m[axis] = absolute ? *value * unit_m_ : target_m[axis] + *value * unit_m_;
    }
    return target_m;
  }

  const std::array<double, 3>& machine_zero(const std::string& word) const {
    if (!settings_.machine_zero_m)
      fail(word + " needs the machine's zero; state `machine_zero`, its position in the coordinates of the program");
    return *settings_.machine_zero_m;
  }

  void go_to_reference(Code code, Words& words) {
    std::array<bool, 3> named = {words.has('X'), words.has('Y'), words.has('Z')};
    const bool all = !named[0] && !named[1] && !named[2];
    const std::array<double, 3>& zero_m = machine_zero(Words::name('G', code));
    motion_.rapid_to(take_target(words, absolute_));
    std::array<double, 3> target_m = motion_.position_m;
    for (int axis = 0; axis < 3; ++axis) {
      if (all || named[axis]) target_m[axis] = zero_m[axis];
    }
    motion_.rapid_to(target_m);
  }

  void move(const std::vector<Code>& g, Words& words) {
    const std::optional<Code> named = of_group(g, "motion");
    if (named) {
      if (!is_drilling(named) || !is_drilling(modal_)) drilling_ = {};
      modal_ = named;
    }
    const bool arc = modal_ == 20 || modal_ == 30;
    if (!words.has_any("XYZ") && !(arc && (named || words.has_any("IJKR"))) && !(named && is_drilling(modal_))) {
      if (contains(g, 530)) fail("G53 without a straight move; X, Y or Z are wanted with it");
      return;
    }
    if (!modal_) fail("axis words before any motion word; G0 or G1 is wanted first");
    if (contains(g, 530)) {
      if (modal_ != 0 && modal_ != 10) fail("G53 goes with G0 and G1 alone");
      std::array<double, 3> target_m = motion_.position_m;
      const std::array<double, 3>& zero_m = machine_zero("G53");
      for (int axis = 0; axis < 3; ++axis) {
        if (const auto value = words.take(static_cast<char>('X' + axis))) target_m[axis] = zero_m[axis] + *value * unit_m_;
      }
      modal_ == 0 ? motion_.rapid_to(target_m) : motion_.feed_to(target_m);
    } else if (modal_ == 0) {
      motion_.rapid_to(take_target(words, absolute_));
    } else if (modal_ == 10) {
      motion_.feed_to(take_target(words, absolute_));
    } else if (arc) {
      move_along_arc(words);
    } else if (modal_ == 800) {
      fail("axis words after G80; a motion word such as G0 is wanted");
    } else {
      drill_holes(words);
    }
  }

  void move_along_arc(Words& words) {
    const bool clockwise = modal_ == 20;
    const auto [u, v] = plane_axes(normal_);
    const std::array<double, 3> target_m = take_target(words, absolute_);
    const int turns = words.has('P') ? words.take_count('P') : 1;
    std::array<double, 3> centre_m = motion_.position_m;
    if (const auto radius = words.take('R')) {
      try {
        centre_m = arc_centre(motion_.position_m, target_m, *radius * unit_m_, normal_, clockwise);
      } catch (const RangeError& e) {
        fail(e.what());
      }
    } else {
      int n_offsets = 0;
      for (int axis : {u, v}) {
        const auto offset = words.take(static_cast<char>('I' + axis));
        if (!offset) continue;
        ++n_offsets;
        centre_m[axis] = *offset * unit_m_ + (absolute_centre_ ? 0.0 : motion_.position_m[axis]);
      }
      if (n_offsets == 0 || (absolute_centre_ && n_offsets < 2)) {
        fail(fmt::format("an arc without its centre; {}{} {} (plane G1{}) or R is wanted",
                         static_cast<char>('I' + std::min(u, v)), absolute_centre_ ? " and" : " or",
                         static_cast<char>('I' + std::max(u, v)), 9 - normal_));
      }
    }
    motion_.arc_to(target_m, centre_m, normal_, clockwise, turns);
  }

  struct Sticky {  // words of a series of canned cycles that hold until they are changed; lengths as written [m]
    std::optional<Code> code;
    std::optional<double> bottom_m, retract_m, peck_m, dwell_s, initial_m;
  };

  void drill_holes(Words& words) {
    const auto [u, v] = plane_axes(normal_);
    const Code code = *modal_ / 10;
    if (!words.has_any("XYZ")) fail("a canned cycle without axis words; X, Y or Z is wanted");
    if (drilling_.code != code) {
      drilling_.bottom_m = drilling_.peck_m = drilling_.dwell_s = std::nullopt;
      drilling_.code = code;
    }
    const auto update = [&](char letter, double factor, std::optional<double>& value) {
      if (const auto given = words.take(letter)) value = *given * factor;
    };
    const bool pecks = code == 73 || code == 83, dwells = code == 82 || code == 84;
    const char normal_letter = static_cast<char>('X' + normal_);
    update(normal_letter, unit_m_, drilling_.bottom_m);
    update('R', unit_m_, drilling_.retract_m);
    if (pecks) update('Q', unit_m_, drilling_.peck_m);
    if (dwells && words.has('P')) drilling_.dwell_s = words.take_not_negative('P') * settings_.dwell_P_s;
    if (!drilling_.bottom_m || !drilling_.retract_m || (pecks && !drilling_.peck_m) || (code == 82 && !drilling_.dwell_s)) {
      fail(fmt::format("G{} without all it needs: {}, R{}{}", code, normal_letter, pecks ? ", Q" : "",
                       code == 82 ? ", P" : ""));
    }
    NcDrilling cycle{.code = code, .normal = normal_};
    const double level_m = motion_.position_m[normal_];
    if (!drilling_.initial_m) drilling_.initial_m = level_m;
    cycle.n_holes = words.has('L') ? words.take_count('L') : 1;
    cycle.retract_m = absolute_ ? *drilling_.retract_m : level_m + *drilling_.retract_m;
    cycle.bottom_m = absolute_ ? *drilling_.bottom_m : cycle.retract_m + *drilling_.bottom_m;
    cycle.clear_m = to_initial_level_ ? std::max(*drilling_.initial_m, cycle.retract_m) : cycle.retract_m;
    cycle.peck_m = drilling_.peck_m.value_or(0.0);
    cycle.dwell_s = drilling_.dwell_s.value_or(0.0);
    const std::array<double, 3> first_m = take_target(words, absolute_);
    cycle.first_m = {first_m[u], first_m[v]};
    if (!absolute_) cycle.spacing_m = {first_m[u] - motion_.position_m[u], first_m[v] - motion_.position_m[v]};
    drill(motion_, cycle);
  }

  const NcSettings& settings_;
  NcMotion motion_;
  double unit_m_ = kMillimetre_m;
  int normal_ = 2;
  bool absolute_ = true, absolute_centre_ = false, to_initial_level_ = true;
  std::optional<Code> modal_, system_;
  Sticky drilling_;
  std::set<std::string> noted_;
  std::vector<std::string> notes_;
};

}  // namespace

double NcProgram::duration_s() const {
  double sum_s = 0.0;
  for (const NcMove& m : moves) sum_s += m.duration_s;
  return sum_s;
}

NcProgram read_nc_program(const std::string& path, const NcSettings& settings) {
  Interpreter interpreter(settings);
  for (const NcBlock& block : read_nc_blocks(path)) {
    if (!interpreter.run(block)) return std::move(interpreter).result();
  }
  throw InputError(fmt::format("{}: the program has no end; a last block M2 or M30, or '%' is wanted", path));
}

}  // namespace driftwright
