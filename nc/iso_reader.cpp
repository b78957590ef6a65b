// One reader of one language: its modes are the state that each word changes.
#include "nc/iso_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "nc/arc.hpp"
#include "nc/block.hpp"
#include "nc/drilling.hpp"
#include "nc/iso_origin.hpp"
#include "nc/iso_source.hpp"
#include "nc/units.hpp"
#include "nc/words.hpp"

namespace driftwright {
namespace {

bool is_drilling(std::optional<NcCode> motion) {
  return motion && is_canned_cycle(*motion);
}

class IsoReader {
 public:
  IsoReader(NcExecution& run, const IsoVariant& variant) : run_(run), variant_(variant), motion_(run.motion), origin_(run) {}

  /// The value of a parameter that the machine itself provides, or none.
  std::optional<NcValue> parameter(const std::string& name) {
    static const std::map<std::string, int> kPositions = {{"<_X>", 0}, {"<_Y>", 1}, {"<_Z>", 2}};
    const auto here = [&](int axis) { return NcValue{motion_.position_m[axis] / run_.unit_m, run_.knows_place(axis)}; };
    if (const auto place = kPositions.find(name); place != kPositions.end()) return here(place->second);
    if (name == "<_FEED>" || name == "<_F>") return NcValue{motion_.feed * 60.0 / run_.feed_unit_m};
    if (name == "<_RPM>") return NcValue{motion_.programmed_rpm};
    if (name == "<_METRIC>") return NcValue{run_.unit_m == kMillimetre_m ? 1.0 : 0.0};
    if (name == "<_IMPERIAL>") return NcValue{run_.unit_m == kMillimetre_m ? 0.0 : 1.0};
    if (name == "<_ABSOLUTE>") return NcValue{run_.absolute ? 1.0 : 0.0};
    if (name == "<_INCREMENTAL>") return NcValue{run_.absolute ? 0.0 : 1.0};
    if (name == "<_SPINDLE_ON>") return NcValue{motion_.turning ? 1.0 : 0.0};
    if (name == "<_SELECTED_TOOL>") return NcValue{tool_};
    if (name[0] == '<') {
      if (!name.starts_with("<_HAL[") && !name.starts_with("<_INI[")) return std::nullopt;
      run_.note("#" + name, "its value is known only at the machine; it is planned as 0");
      return NcValue{0.0, false};
    }
    const int number = std::stoi(name);
    if (number >= 5420 && number <= 5422) return here(number - 5420);
    if (number >= 5061 && number <= 5063) return NcValue{probed_m_[number - 5061] / run_.unit_m, false};
    if (number == 5070) return NcValue{1.0, false};
    if (number == 5220) return NcValue{static_cast<double>(origin_.system()), origin_.system_named()};
    if (number == 5400) return NcValue{tool_};
    if (const auto given = run_.settings().parameters.find(number); given != run_.settings().parameters.end())
      return NcValue{given->second};
    if (number < 5000) return std::nullopt;
    run_.note("#" + name, "its value is known only at the machine; it is planned as 0");
    return NcValue{0.0, false};
  }

  /// @returns true  if the program continues
  bool read(const NcBlock& block) {
    const std::string& line = block.where.excerpt;
    const auto first = line.find_first_not_of(" \t");
    run_.begin(block.where, first != std::string::npos && line[first] == '/');
    look_at(block);
    if (block.words[0].letter == '%') {
      run_.step().ends_program = true;
      run_.end();
      return false;
    }
    NcWords words(block);
    const std::vector<NcCode> g = words.take_codes('G', run_.settings().ignored);
    const std::vector<NcCode> m = words.take_codes('M', run_.settings().ignored);
    for (const std::string& word : words.unknown()) run_.pass_over(word);
    const bool waits = !m.empty() || !words.unknown().empty() || words.has_any("ST") || of_group(g, "coordinate system") ||
                       of_group(g, "origin") || contains(g, 100);
    if (waits) motion_.stop();
    if (const auto language = of_group(g, "language"); language && (*language != 2910 || !variant_.has_g291))
      run_.fail(fmt::format("{}: a program must be in one language from its first to its last block",
                            nc_word_name('G', *language)));
    for (const NcCode cancel : {500, 501}) {  // alone they end scaling and mirroring, which do not begin here
      if (contains(g, cancel) && words.has_any("SXYZIJKPR"))
        run_.fail(
            fmt::format("{}: with other words in its block it does more than end scaling or mirroring, which is not "
                        "followed here; write it in a block without S, X, Y, Z, I, J, K, P and R",
                        nc_word_name('G', cancel)));
    }
    if (contains(g, 200)) run_.unit_m = run_.feed_unit_m = kInch_m;
    if (contains(g, 210)) run_.unit_m = run_.feed_unit_m = kMillimetre_m;
    set_feed(g, words);
    if (words.has('S')) motion_.programmed_rpm = words.take_not_negative('S');
    if (words.has('T')) tool_ = words.take('T').value();
    set_spindle(m);
    if (contains(g, 40)) dwell(g, words);
    set_modes(g, words);
    if (const auto reference = of_group(g, "reference point")) go_to_reference(*reference, words);
    move(g, words);
    if (motion_.feed_mode == NcFeedMode::InverseTime) motion_.feed = 0.0;  // an F applies to its own block only
    words.reject_unused();
    NcStep& step = run_.step();
    step.motion_word = of_group(g, "motion").has_value() || contains(g, 800);
    step.unit_word = contains(g, 200) || contains(g, 210);
    step.system = of_group(g, "coordinate system");
    if (step.system && variant_.work_offset_resets) step.resets = {true, true, true};
    step.ends_program = contains(m, 20) || contains(m, 300);
    if (of_group(g, "tool length")) run_.forget();
    run_.end();
    return !step.ends_program;
  }

 private:
  /// Stores the properties of a block that inserted lines need.
  void look_at(const NcBlock& block) {
    NcStep& step = run_.step();
    step.plain = true;
    for (const NcWord& word : block.words) {
      const bool straight = word.letter == 'G' && (word.value == 0.0 || word.value == 1.0);
      step.plain = step.plain && !word.computed && (straight || std::string("XYZF").find(word.letter) != std::string::npos);
      if (word.letter == 'F') step.feed_word = word.text;
    }
  }

  void set_feed(const std::vector<NcCode>& g, NcWords& words) {
    if (const std::optional<NcCode> mode = of_group(g, "feed mode")) {
      run_.set_feed_mode(*mode == 930   ? NcFeedMode::InverseTime
                         : *mode == 940 ? NcFeedMode::PerMinute
                                        : NcFeedMode::PerRevolution);
    }
    if (words.has('F')) run_.set_feed(words.take_not_negative('F'));
  }

  void set_spindle(const std::vector<NcCode>& m) {
    if (contains(m, 60)) run_.change_tool("M6");
    for (const NcCode halt : {0, 10, 600}) {
      if (contains(m, halt)) run_.halt(nc_word_name('M', halt));
    }
    if (contains(m, 30) || contains(m, 40)) motion_.turning = true;
    if (contains(m, 50) || contains(m, 190)) motion_.turning = false;
  }

  void dwell(const std::vector<NcCode>& g, NcWords& words) {
    if (words.has('P')) {
      motion_.wait(words.take_not_negative('P') * run_.settings().dwell_P_s);
    } else if (!of_group(g, "motion") && words.has_any("XU")) {
      motion_.wait(words.take_not_negative(words.has('X') ? 'X' : 'U'));
    } else {
      run_.fail("G4 has no time; write P, or X or U in seconds");
    }
  }

  void set_modes(const std::vector<NcCode>& g, NcWords& words) {
    if (contains(g, 170)) run_.normal = 2;
    if (contains(g, 180)) run_.normal = 1;
    if (contains(g, 190)) run_.normal = 0;
    if (contains(g, 410) || contains(g, 420)) {
      (void)words.take('D');
      run_.compensated = true;
      run_.note(contains(g, 410) ? "G41" : "G42",
                "cutter compensation is not followed; the path is counted along the programmed contour");
    }
    if (contains(g, 430)) (void)words.take('H');
    if (contains(g, 400)) {
      run_.compensated = false;
      (void)words.take('D');
    }
    if (contains(g, 490)) (void)words.take('H');
    if (const auto system = of_group(g, "coordinate system"))
      origin_.use(work_offset_number(*system), nc_word_name('G', *system));
    if (contains(g, 100)) set_offset(words);
    if (const auto shift = of_group(g, "origin")) shift_origin(*shift, words);
    if (contains(g, 610) || contains(g, 611)) motion_.blend_m = 0.0;
    if (contains(g, 640)) {
      const auto tolerance = words.take('P');
      motion_.blend_m = tolerance ? *tolerance * run_.unit_m : -1.0;
      (void)words.take('Q');
    }
    if (contains(g, 900)) run_.absolute = true;
    if (contains(g, 910)) run_.absolute = false;
    if (contains(g, 901)) absolute_centre_ = true;
    if (contains(g, 911)) absolute_centre_ = false;
    if (contains(g, 980)) to_initial_level_ = true;
    if (contains(g, 990)) to_initial_level_ = false;
  }

  /// Target of the block's X, Y, Z; axes that it does not name keep their position.
  std::array<double, 3> take_target(NcWords& words, bool absolute) {
    std::array<double, 3> target_m = motion_.position_m;
    NcStep& step = run_.step();
    for (int axis = 0; axis < 3; ++axis) {
      step.certain = step.certain && words.certain(static_cast<char>('X' + axis));
      const auto value = words.take(static_cast<char>('X' + axis));
      step.named[axis] = step.named[axis] || value.has_value();
      if (value) target_m[axis] = absolute ? *value * run_.unit_m : target_m[axis] + *value * run_.unit_m;
    }
    return target_m;
  }

  /// G10 L2 Pn, L20 Pn: sets a work offset; L1, L10, L11 of the tool table move nothing here.
  void set_offset(NcWords& words) {
    const auto l = words.take('L');
    if (!l) run_.fail("G10 without its L");
    const long kind = std::lround(*l);
    if (kind == 1 || kind == 10 || kind == 11) {
      words.take_all("PXYZABCUVWRIJQ");
      if (kind != 1) run_.forget();
      return;
    }
    if (kind != 2 && kind != 20)
      run_.fail(fmt::format("G10 L{}: of G10 only L1, L2, L10, L11 and L20 are known here", kind));
    const long p = words.has('P') ? std::lround(words.take('P').value()) : -1;
    if (p < 0 || p > 9) run_.fail("G10 L2 and L20 require P0 to P9");
    const int system = p == 0 ? origin_.system() : static_cast<int>(p);
    run_.step().sets_offset = true;
    for (int axis = 0; axis < 3; ++axis) {
      const bool certain = words.certain(static_cast<char>('X' + axis));
      const auto x = words.take(static_cast<char>('X' + axis));
      if (!x) continue;
      if (kind == 2) {
        origin_.set(system, axis, *x * run_.unit_m);
        if (!certain && system == origin_.system()) run_.forget();
      } else {
        origin_.set_here(system, axis, *x * run_.unit_m);
        if (certain && system == origin_.system()) run_.know(axis);
      }
    }
    if (words.has('R')) {
      if (words.take('R').value() != 0.0) run_.fail("a rotated work offset (R) is not followed here");
    }
    words.take_all("ABCUVW");
  }

  /// G52, G92, G92.1, G92.2.
  void shift_origin(NcCode code, NcWords& words) {
    NcStep& step = run_.step();
    if (code == 921 || code == 922) {
      origin_.clear_shift();
      step.resets = {true, true, true};
      step.own_shift = {true, true, true};
      return;
    }
    if (!words.has_any("XYZ")) run_.fail(fmt::format("{} without X, Y or Z", nc_word_name('G', code)));
    for (int axis = 0; axis < 3; ++axis) {
      const bool certain = words.certain(static_cast<char>('X' + axis));
      const auto x = words.take(static_cast<char>('X' + axis));
      if (!x) continue;
      step.own_shift[axis] = true;
      if (code == 520) {
        origin_.set_shift(axis, *x * run_.unit_m);
        step.resets[axis] = true;
        if (!certain) run_.forget();
      } else {
        origin_.shift_here(axis, *x * run_.unit_m);
        if (certain) run_.know(axis);
      }
    }
  }

  void go_to_reference(NcCode code, NcWords& words) {
    std::array<bool, 3> named = {words.has('X'), words.has('Y'), words.has('Z')};
    const bool all = !named[0] && !named[1] && !named[2];
    const std::array<double, 3>& zero_m = run_.machine_zero(nc_word_name('G', code));
    run_.rapid_to(take_target(words, run_.absolute));
    std::array<double, 3> target_m = motion_.position_m;
    for (int axis = 0; axis < 3; ++axis) {
      if (all || named[axis]) target_m[axis] = zero_m[axis];
    }
    run_.rapid_to(target_m);
    run_.step().kind = NcStepKind::kMachine;
  }

  void move(const std::vector<NcCode>& g, NcWords& words) {
    const std::optional<NcCode> named = of_group(g, "motion");
    std::optional<int>& modal = run_.motion_word;
    if (named) {
      if (!is_drilling(named) || !is_drilling(modal)) drilling_ = {};
      modal = named;
    } else if (contains(g, 800)) {
      modal = 800;
    }
    const bool arc = modal == 20 || modal == 30, probe = modal && *modal >= 382 && *modal <= 385;
    if (!words.has_any("XYZ") && !(arc && (named || words.has_any("IJKR"))) && !(named && is_drilling(modal))) {
      if (contains(g, 530)) run_.fail("G53 has no straight move; write X, Y or Z with it");
      return;
    }
    if (!modal) run_.fail("axis words come before any motion word; write G0 or G1 first");
    if (contains(g, 530)) {
      if (modal != 0 && modal != 10) run_.fail("G53 is allowed only with G0 and G1");
      std::array<double, 3> target_m = motion_.position_m;
      const std::array<double, 3>& zero_m = run_.machine_zero("G53");
      for (int axis = 0; axis < 3; ++axis) {
        if (const auto value = words.take(static_cast<char>('X' + axis)))
          target_m[axis] = zero_m[axis] + *value * run_.unit_m;
      }
      modal == 0 ? run_.rapid_to(target_m) : run_.feed_to(target_m);
      run_.step().kind = NcStepKind::kMachine;
    } else if (modal == 0) {
      run_.rapid_to(take_target(words, run_.absolute));
    } else if (modal == 10) {
      run_.feed_to(take_target(words, run_.absolute));
    } else if (probe) {
      run_.note(nc_word_name('G', *modal),
                "where it touches is known only at the machine; it is planned as if at the end of its way, and the rest "
                "counts on from there");
      run_.feed_to(take_target(words, run_.absolute));
      probed_m_ = motion_.position_m;
      run_.step().certain = false;
      run_.step().no_place = true;
    } else if (arc) {
      move_along_arc(words);
    } else if (modal == 800) {
      run_.fail("axis words come after G80; write a motion word such as G0");
    } else {
      drill_holes(words);
    }
  }

  void move_along_arc(NcWords& words) {
    const bool clockwise = run_.motion_word == 20;
    const auto [u, v] = plane_axes(run_.normal);
    const std::array<double, 3> target_m = take_target(words, run_.absolute);
    const int turns = words.has('P') ? words.take_count('P') : 1;
    std::array<double, 3> centre_m = motion_.position_m;
    if (const auto radius = words.take('R')) {
      centre_m = run_.centre_of(target_m, *radius * run_.unit_m, clockwise);
    } else {
      int n_offsets = 0;
      for (int axis : {u, v}) {
        const auto offset = words.take(static_cast<char>('I' + axis));
        if (!offset) continue;
        ++n_offsets;
        centre_m[axis] = *offset * run_.unit_m + (absolute_centre_ ? 0.0 : motion_.position_m[axis]);
      }
      if (n_offsets == 0 || (absolute_centre_ && n_offsets < 2)) {
        run_.fail(fmt::format("the arc has no centre; write {}{} {} (plane G1{}) or R",
                              static_cast<char>('I' + std::min(u, v)), absolute_centre_ ? " and" : " or",
                              static_cast<char>('I' + std::max(u, v)), 9 - run_.normal));
      }
    }
    run_.arc_to(target_m, centre_m, clockwise, turns);
  }

  struct Sticky {  // words of a series of canned cycles that apply until they are changed; lengths as written [m]
    std::optional<NcCode> code;
    std::optional<double> bottom_m, retract_m, peck_m, dwell_s, initial_m;
  };

  void drill_holes(NcWords& words) {
    run_.step().kind = NcStepKind::kDrilling;
    const auto [u, v] = plane_axes(run_.normal);
    const NcCode code = *run_.motion_word / 10;
    if (!words.has_any("XYZ")) run_.fail("the canned cycle has no axis words; write X, Y or Z");
    if (drilling_.code != code) {
      drilling_.bottom_m = drilling_.peck_m = drilling_.dwell_s = std::nullopt;
      drilling_.code = code;
    }
    const auto update = [&](char letter, double factor, std::optional<double>& value) {
      if (const auto given = words.take(letter)) value = *given * factor;
    };
    const bool pecks = code == 73 || code == 83, dwells = code == 82 || code == 84;
    const char normal_letter = static_cast<char>('X' + run_.normal);
    update(normal_letter, run_.unit_m, drilling_.bottom_m);
    update('R', run_.unit_m, drilling_.retract_m);
    if (pecks) update('Q', run_.unit_m, drilling_.peck_m);
    if (dwells && words.has('P')) drilling_.dwell_s = words.take_not_negative('P') * run_.settings().dwell_P_s;
    if (!drilling_.bottom_m || !drilling_.retract_m || (pecks && !drilling_.peck_m) || (code == 82 && !drilling_.dwell_s)) {
      run_.fail(fmt::format("G{} requires {}, R{}{}", code, normal_letter, pecks ? ", Q" : "", code == 82 ? ", P" : ""));
    }
    NcDrilling cycle{.code = code, .normal = run_.normal};
    const double level_m = motion_.position_m[run_.normal];
    if (!drilling_.initial_m) drilling_.initial_m = level_m;
    cycle.n_holes = words.has('L') ? words.take_count('L') : 1;
    cycle.retract_m = run_.absolute ? *drilling_.retract_m : level_m + *drilling_.retract_m;
    cycle.bottom_m = run_.absolute ? *drilling_.bottom_m : cycle.retract_m + *drilling_.bottom_m;
    cycle.clear_m = to_initial_level_ ? std::max(*drilling_.initial_m, cycle.retract_m) : cycle.retract_m;
    cycle.peck_m = drilling_.peck_m.value_or(0.0);
    cycle.dwell_s = drilling_.dwell_s.value_or(0.0);
    const std::array<double, 3> first_m = take_target(words, run_.absolute);
    cycle.first_m = {first_m[u], first_m[v]};
    if (!run_.absolute) cycle.spacing_m = {first_m[u] - motion_.position_m[u], first_m[v] - motion_.position_m[v]};
    drill(motion_, cycle);
  }

  NcExecution& run_;
  const IsoVariant variant_;
  NcMotion& motion_;
  IsoOrigin origin_;
  bool absolute_centre_ = false, to_initial_level_ = true;
  double tool_ = 0.0;
  std::array<double, 3> probed_m_ = {0, 0, 0};
  Sticky drilling_;
};

}  // namespace

void run_iso_program(const std::string& path, const std::vector<std::string>& lines, NcExecution& run,
                     const IsoVariant& variant) {
  IsoReader reader(run, variant);
  IsoSource source(path, lines, run, [&](const std::string& name) { return reader.parameter(name); });
  while (const std::optional<NcBlock> block = source.next()) {
    if (!reader.read(*block)) return;
  }
  throw InputError(fmt::format("{}: the program has no end; write M2, M30 or '%' as its last block", path));
}

}  // namespace driftwright
