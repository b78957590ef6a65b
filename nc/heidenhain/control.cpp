// Heidenhain's controls: plain language and DIN/ISO, with corrections as increments of the datum shift.

#include <fmt/format.h>

#include "nc/controls.hpp"
#include "nc/heidenhain/din_reader.hpp"
#include "nc/heidenhain/klartext_lines.hpp"
#include "nc/heidenhain/klartext_reader.hpp"
#include "nc/written_words.hpp"

namespace driftwright {
namespace {

/// Corrections are added to the datum shift in force by the difference. Absolute: the datum shift is set.
/// Source: Heidenhain, TNC 640 User's Manual Cycle Programming, cycle 7: an incremental shift counts from the datum in
/// force.
class Heidenhain : public NcLanguage {
 public:
  std::string remark_line(const std::string& text) const override { return "; " + text; }

  void check(const std::vector<NcStep>& steps, const NcOffsetOptions& options) const override {
    if (!options.absolute) return;
    for (const NcStep& step : steps) {
      if (step.resets != std::array<bool, 3>{})
        throw InputError(step.where,
                         "a datum shift of the program's own, which absolute offsets would undo; `offset: add` adds to it");
    }
  }

  std::string offset_name(const NcOffsetOptions& /*options*/) const override { return "The datum shift"; }
  std::string remark(const NcOffsetOptions& /*options*/) const override {
    return "driftwright: corrections of drift as datum shifts, added to the one in force. After an abort select the "
           "program anew";
  }
  std::string advice(bool /*absolute*/) const override {
    return "Corrections are added to the datum shift in force by differences and taken back at the end; after an abort "
           "select the program anew. "
           "Written by the maker's manuals: no TNC has run this program here; run it without a tool in the work first.";
  }

 protected:
  /// The datum shift to write: of all corrected axes (absolute), or the increment of those that change.
  static std::array<std::optional<double>, 3> shift_m(const NcOffsetOptions& options, const NcShift& shift) {
    std::array<std::optional<double>, 3> x_m{};
    for (int axis = 0; axis < 3; ++axis) {
      if (options.absolute && options.axes[axis]) x_m[axis] = options.base_m[axis] + shift.to_m[axis];
      if (!options.absolute && shift.axes[axis] && shift.to_m[axis] != shift.from_m[axis])
        x_m[axis] = shift.to_m[axis] - shift.from_m[axis];
    }
    return x_m;
  }
};

/// %NAME G71 *. Corrections: `G54 G91 X-0.0025`, `G90`; absolute: `G54 X+0.0125`.
class HeidenhainDin final : public Heidenhain {
 public:
  std::string name() const override { return "Heidenhain DIN/ISO"; }
  bool recognises(const std::vector<std::string>& /*lines*/) const override { return true; }
  void read(const std::string& path, const std::vector<std::string>& lines, NcExecution& run) const override {
    run_heidenhain_program(path, lines, run);
  }
  std::vector<std::string> offset_lines(const NcOffsetOptions& options, const NcShift& shift) const override {
    const std::string words = axis_words(shift_m(options, shift), shift.before.unit_m, signed_length);
    if (words.empty() && !options.absolute) return {};
    std::vector<std::string> lines = {(!options.absolute ? "G54 G91" : shift.before.absolute ? "G54" : "G54 G90") + words};
    if (options.absolute != shift.before.absolute)
      lines.emplace_back(shift.before.absolute ? "G90" : "G91");  // restores the mode
    return lines;
  }
  std::vector<std::string> straight_lines(const NcLine& line) const override {
    return iso_straight_lines((line.rapid ? "G00" : "G01") + axis_words(line.to_m, line.before.unit_m, signed_length),
                              line.feed, line.before.absolute);
  }
  NcBlockForm block_form() const override { return {.number_letter = "N", .end = "*"}; }
  std::string unit_words() const override { return "%NAME G71 or %NAME G70"; }
};

/// BEGIN PGM NAME MM. Corrections: `CYCL DEF 7.0`, `CYCL DEF 7.1 IX-0.0025`; absolute: `CYCL DEF 7.1 X+0.0125`.
class Klartext final : public Heidenhain {
 public:
  std::string name() const override { return "Heidenhain plain language"; }
  bool recognises(const std::vector<std::string>& lines) const override { return is_klartext(lines); }
  void read(const std::string& path, const std::vector<std::string>& lines, NcExecution& run) const override {
    run_klartext_program(path, lines, run);
  }
  std::vector<std::string> offset_lines(const NcOffsetOptions& options, const NcShift& shift) const override {
    const std::array<std::optional<double>, 3> x_m = shift_m(options, shift);
    std::vector<std::string> lines = {"CYCL DEF 7.0 DATUM SHIFT"};
    for (int axis = 0; axis < 3; ++axis) {
      if (x_m[axis])
        lines.push_back(fmt::format("CYCL DEF 7.{} {}{}{}", lines.size(), options.absolute ? "" : "I", "XYZ"[axis],
                                    signed_length(*x_m[axis], shift.before.unit_m)));
    }
    return lines.size() > 1 ? lines : std::vector<std::string>{};
  }
  std::vector<std::string> straight_lines(const NcLine& line) const override {
    const std::string words = "L" + axis_words(line.to_m, line.before.unit_m, signed_length);
    return {words + (line.feed.empty() ? "" : " " + line.feed) + (line.rapid ? " FMAX" : "")};
  }
  NcBlockForm block_form() const override { return {.number_letter = "", .end = ""}; }
  std::string unit_words() const override { return "BEGIN PGM NAME MM"; }
};

}  // namespace

NcControl heidenhain_control() {
  static const Klartext klartext;
  static const HeidenhainDin din;
  return {.key = "heidenhain",
          .title = "Heidenhain",
          .about = "DIN/ISO or plain language",
          .named_words = true,
          .languages = {&klartext, &din}};
}

}  // namespace driftwright
