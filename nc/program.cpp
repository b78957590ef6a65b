#include "nc/program.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "nc/arc.hpp"
#include "nc/drilling.hpp"
#include "nc/words.hpp"

namespace driftwright {
namespace {

constexpr double kInch_m = 0.0254, kMillimetre_m = 1e-3;

bool is_drilling(std::optional<NcCode> motion) {
  return motion && *motion >= 730 && *motion != 800;
}

class Interpreter {
 public:
  explicit Interpreter(const NcSettings& settings) : settings_(settings), motion_(settings.rapid_m_s) {}

  /// @returns whether the program goes on
  bool run(const NcBlock& block) {
    motion_.where = block.where;
    begin_step(block);
    if (block.words[0].letter == '%') return !(steps_.back().ends_program = true);
    NcWords words(block);
    const std::vector<NcCode> g = words.take_codes('G', settings_.ignored);
    const std::vector<NcCode> m = words.take_codes('M', settings_.ignored);
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
    end_step(g, m);
    return !steps_.back().ends_program;
  }

  NcProgram result() && { return {motion_.moves(), std::move(steps_), std::move(notes_)}; }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError(motion_.where, message); }

  void note(const std::string& word, const std::string& message) {
    if (noted_.insert(word).second) notes_.push_back(fmt::format("line {}: {}: {}", motion_.where.line, word, message));
  }

  void begin_step(const NcBlock& block) {
    NcStep step{.where = block.where, .start_s = time_s_, .end_s = time_s_, .start_m = motion_.position_m};
    step.end_m = step.start_m;
    step.known = known_;
    step.before = {.motion = modal_,
                   .absolute = absolute_,
                   .compensated = compensated_,
                   .unit_m = unit_m_,
                   .feed_mode = motion_.feed_mode,
                   .has_feed = motion_.feed > 0.0};
    const std::string& line = block.where.excerpt;
    const auto first = line.find_first_not_of(" \t");
    step.deletable = first != std::string::npos && line[first] == '/';
    step.plain = true;
    for (const NcWord& word : block.words) {
      const bool straight = word.letter == 'G' && (word.value == 0.0 || word.value == 1.0);
      step.plain = step.plain && (straight || std::string("XYZF").find(word.letter) != std::string::npos);
      if (word.letter == 'F') step.feed_word = word.text;
    }
    steps_.push_back(std::move(step));
  }

  void end_step(const std::vector<NcCode>& g, const std::vector<NcCode>& m) {
    for (; n_timed_ < motion_.moves().size(); ++n_timed_) time_s_ += motion_.moves()[n_timed_].duration_s;
    NcStep& step = steps_.back();
    step.end_s = time_s_;
    step.end_m = motion_.position_m;
    step.absolute = absolute_;
    step.motion_word = of_group(g, "motion").has_value();
    step.compensated = compensated_;
    step.unit_word = contains(g, 200) || contains(g, 210);
    step.tool_change = contains(m, 60);
    step.system = of_group(g, "coordinate system");
    step.ends_program = contains(m, 20) || contains(m, 300);
    // Another tool, length or zero: the numbers of before are other places now.
    if (step.tool_change || step.system || of_group(g, "tool length")) known_ = {false, false, false};
    if (step.kind == NcStepKind::kNone) return;
    for (int axis = 0; axis < 3; ++axis) {
      if (step.kind == NcStepKind::kMachine || (step.deletable && step.named[axis])) {
        known_[axis] = false;
      } else if (step.named[axis] && absolute_ && !(step.kind == NcStepKind::kDrilling && axis == normal_)) {
        known_[axis] = true;  // the level at the end of a drilling series is that of its start or R: no news
      }
    }
  }

  void set_feed(const std::vector<NcCode>& g, NcWords& words) {
    const std::optional<NcCode> mode = of_group(g, "feed mode");
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

  void set_spindle(const std::vector<NcCode>& m) {
    if (contains(m, 60)) {
      if (!settings_.tool_change_s)
        fail("M6 changes the tool, but nobody says how long that takes; state `tool_change`, such as 8 s");
      motion_.turning = false;
      motion_.wait(*settings_.tool_change_s);
    }
    for (const NcCode halt : {0, 10, 600}) {
      if (contains(m, halt))
        note(nc_word_name('M', halt), "a halt counts as no time; all that comes later is timed as if nobody waited");
    }
    if (contains(m, 30) || contains(m, 40)) motion_.turning = true;
    if (contains(m, 50) || contains(m, 190)) motion_.turning = false;
  }

  void dwell(const std::vector<NcCode>& g, NcWords& words) {
    if (words.has('P')) {
      motion_.wait(words.take_not_negative('P') * settings_.dwell_P_s);
    } else if (!of_group(g, "motion") && words.has_any("XU")) {
      motion_.wait(words.take_not_negative(words.has('X') ? 'X' : 'U'));
    } else {
      fail("G4 without its time; P, or X or U in seconds, is wanted");
    }
  }

  void set_modes(const std::vector<NcCode>& g, NcWords& words) {
    if (contains(g, 170)) normal_ = 2;
    if (contains(g, 180)) normal_ = 1;
    if (contains(g, 190)) normal_ = 0;
    if (contains(g, 410) || contains(g, 420)) {
      (void)words.take('D');
      compensated_ = true;
      note(contains(g, 410) ? "G41" : "G42", "cutter compensation; the path is counted along the programmed contour");
    }
    if (contains(g, 430)) (void)words.take('H');
    if (contains(g, 400)) {
      compensated_ = false;
      (void)words.take('D');
    }
    if (contains(g, 490)) (void)words.take('H');
    if (const auto system = of_group(g, "coordinate system")) {
      if (system_ && *system_ != *system)
        note(nc_word_name('G', *system), "another coordinate system; positions are counted as if in the one before");
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
  std::array<double, 3> take_target(NcWords& words, bool absolute) {
    std::array<double, 3> target_m = motion_.position_m;
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = words.take(static_cast<char>('X' + axis));
      steps_.back().named[axis] = steps_.back().named[axis] || value.has_value();
      if (value) target_m[axis] = absolute ? *value * unit_m_ : target_m[axis] + *value * unit_m_;
    }
    return target_m;
  }

  const std::array<double, 3>& machine_zero(const std::string& word) const {
    if (!settings_.machine_zero_m)
      fail(word + " needs the machine's zero; state `machine_zero`, its position in the coordinates of the program");
    return *settings_.machine_zero_m;
  }

  void go_to_reference(NcCode code, NcWords& words) {
    std::array<bool, 3> named = {words.has('X'), words.has('Y'), words.has('Z')};
    const bool all = !named[0] && !named[1] && !named[2];
    steps_.back().kind = NcStepKind::kMachine;
    const std::array<double, 3>& zero_m = machine_zero(nc_word_name('G', code));
    motion_.rapid_to(take_target(words, absolute_));
    std::array<double, 3> target_m = motion_.position_m;
    for (int axis = 0; axis < 3; ++axis) {
      if (all || named[axis]) target_m[axis] = zero_m[axis];
    }
    motion_.rapid_to(target_m);
  }

  void move(const std::vector<NcCode>& g, NcWords& words) {
    const std::optional<NcCode> named = of_group(g, "motion");
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
    steps_.back().kind = contains(g, 530) ? NcStepKind::kMachine
                         : modal_ == 0    ? NcStepKind::kRapid
                         : modal_ == 10   ? NcStepKind::kLine
                         : arc            ? NcStepKind::kArc
                                          : NcStepKind::kDrilling;
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

  void move_along_arc(NcWords& words) {
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
    std::optional<NcCode> code;
    std::optional<double> bottom_m, retract_m, peck_m, dwell_s, initial_m;
  };

  void drill_holes(NcWords& words) {
    const auto [u, v] = plane_axes(normal_);
    const NcCode code = *modal_ / 10;
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
  bool absolute_ = true, absolute_centre_ = false, to_initial_level_ = true, compensated_ = false;
  double time_s_ = 0.0;
  std::size_t n_timed_ = 0;  // moves that time_s_ counts
  std::array<bool, 3> known_ = {false, false, false};
  std::vector<NcStep> steps_;
  std::optional<NcCode> modal_, system_;
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
