// LinuxCNC: RS-274, with corrections as a shift that is added to all work offsets.

#include <fmt/format.h>

#include <algorithm>

#include "nc/controls.hpp"
#include "nc/iso_reader.hpp"
#include "nc/words.hpp"
#include "nc/written_words.hpp"

namespace driftwright {
namespace {

/// Corrections are a shift added to G54 ... G59.3, which are not changed: `G52 X-0.0125`. If the program itself uses G92 or
/// G52, they are added to that by the difference, because no other offset is free: `G92 X[#5420+0.0025]`. Absolute:
/// `G10 L2 P1 X0.0125`. A line that runs several times, in a loop or subprogram, counts its runs.
/// Source: LinuxCNC documentation, "G-Codes" (G10 L2, G52, G92), "Coordinate Systems", "O Codes".
class LinuxCnc final : public NcLanguage {
 public:
  std::string name() const override { return "LinuxCNC"; }
  bool recognises(const std::vector<std::string>& /*lines*/) const override { return true; }
  void read(const std::string& path, const std::vector<std::string>& lines, NcExecution& run) const override {
    run_iso_program(path, lines, run, {});
  }

  std::vector<std::string> offset_lines(const NcOffsetOptions& options, const NcShift& shift) const override {
    const double unit_m = shift.before.unit_m;
    if (options.shares_shift && !options.absolute) {
      std::string words;
      for (int axis = 0; axis < 3; ++axis) {  // the present position then has another number
        if (shift.axes[axis] && shift.to_m[axis] != shift.from_m[axis])
          words += fmt::format(" {}[#{}{}]", "XYZ"[axis], 5420 + axis,
                               signed_length(shift.from_m[axis] - shift.to_m[axis], unit_m));
      }
      return words.empty() ? std::vector<std::string>{} : std::vector<std::string>{"G92" + words};
    }
    std::array<std::optional<double>, 3> x_m{};
    for (int axis = 0; axis < 3; ++axis) {
      if (shift.axes[axis]) x_m[axis] = (options.absolute ? options.base_m[axis] : 0.0) + shift.to_m[axis];
    }
    const std::string word = options.absolute ? fmt::format("G10 L2 P{}", work_offset_number(options.work_offset)) : "G52";
    return {word + axis_words(x_m, unit_m, written_length)};
  }

  std::string remark_line(const std::string& text) const override { return fmt::format("({})", text); }

  /// Added corrections: lines that stop the program if another G92 or G52 is in force or, for x and y, a rotated work
  /// offset.
  std::vector<std::string> guard_lines(const NcOffsetOptions& options) const override {
    if (options.absolute || options.shares_shift) return {};
    std::string condition;
    for (int axis = 0; axis < 3; ++axis) {
      if (options.axes[axis]) condition += fmt::format("{}[#{} NE 0]", condition.empty() ? "" : " OR ", 5211 + axis);
    }
    std::vector<std::string> lines = {fmt::format("o<driftwright_g92> if [{}]", condition),
                                      "(abort, a G92 or G52 offset is in force where corrections go. G92.1 takes it away)",
                                      "o<driftwright_g92> endif"};
    if (options.axes[0] || options.axes[1]) {
      lines.insert(lines.end(), {"o<driftwright_turn> if [#[5210+20*#5220] NE 0]",
                                 "(abort, the work offset is rotated, and corrections of x and y would be so too)",
                                 "o<driftwright_turn> endif"});
    }
    return lines;
  }

  std::optional<NcRunCounter> run_counter(std::size_t line, int nth_run) const override {
    const std::string counter = fmt::format("#<_driftwright_{}>", line);
    const std::string label = fmt::format("o<driftwright_{}_{}>", line, nth_run);
    return NcRunCounter{.zero = fmt::format("{}=0", counter),
                        .count = fmt::format("{}=[{}+1]", counter, counter),
                        .open = fmt::format("{} if [{} EQ {}]", label, counter, nth_run),
                        .close = label + " endif"};
  }

  std::string unit_words() const override { return "G21 or G20"; }
  bool writes_inches() const override { return true; }

  bool shares_shift(const std::vector<NcStep>& steps) const override {
    return std::any_of(steps.begin(), steps.end(), [](const NcStep& s) { return s.own_shift != std::array<bool, 3>{}; });
  }

  void check(const std::vector<NcStep>& steps, const NcOffsetOptions& options) const override {
    if (!options.absolute) return;
    for (const NcStep& step : steps) {
      if (step.sets_offset || step.own_shift != std::array<bool, 3>{})
        throw InputError(
            step.where,
            "G10, G52 and G92 move the offset that absolute corrections overwrite; `offset: add` goes with them");
      if (step.system && *step.system != options.work_offset) {
        throw InputError(
            step.where,
            fmt::format("{}: absolute offsets go into {}, which `work_offset` names, and into no other; `offset: add` "
                        "corrects them all",
                        nc_word_name('G', *step.system), nc_word_name('G', options.work_offset)));
      }
    }
    check_offset_named(steps, options);
  }

  /// A G92 gives the present position another number: it keeps a correction that the axis has, and loses one that it has not
  /// moved to yet.
  void check_written(const std::vector<NcStep>& steps, std::size_t front, const NcOffsetOptions& options) const override {
    if (!options.shares_shift) return;
    for (std::size_t i = front; i < steps.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        if (!options.axes[axis] || !steps[i].own_shift[axis] || steps[i].resets[axis] || steps[i].known[axis]) continue;
        throw InputError(steps[i].where, fmt::format("G92 of {}, which no block before has moved in G90: a correction in "
                                                     "force would be lost in it; move {} before",
                                                     "XYZ"[axis], "XYZ"[axis]));
      }
    }
  }

  std::string offset_name(const NcOffsetOptions& options) const override { return nc_word_name('G', options.work_offset); }
  std::string remark(const NcOffsetOptions& options) const override {
    return options.shares_shift ? "driftwright: corrections of drift added by differences to the G92 or G52 of this "
                                  "program. After an abort set that anew"
                                : "driftwright: corrections of drift by G52, added to the work offsets, which stay. After "
                                  "an abort G92.1 takes them away";
  }
  std::string advice(bool absolute) const override {
    return absolute
               ? "Corrections overwrite the work offset (G10 L2)."
               : "Corrections are added above the work offsets (G52, or G92 where the program has one), which stay as the "
                 "operator has set "
                 "them. After an abort the one in force stays until G92.1; the program refuses to start above it.";
  }

 private:
  /// A work offset that the program does not name is the one left by an earlier program: G54 after a start, otherwise
  /// unknown.
  static void check_offset_named(const std::vector<NcStep>& steps, const NcOffsetOptions& options) {
    if (options.work_offset == 540) return;
    for (const NcStep& step : steps) {
      if (step.system && !step.deletable) return;
      if (!step.moves()) continue;
      throw InputError(
          step.where,
          fmt::format(
              "no work offset is named before this first motion; write {}, which `work_offset` names, into the program",
              nc_word_name('G', options.work_offset)));
    }
  }
};

}  // namespace

NcControl linuxcnc_control() {
  static const LinuxCnc language;
  return {.key = "linuxcnc", .title = "LinuxCNC", .about = "RS-274", .languages = {&language}};
}

}  // namespace driftwright
