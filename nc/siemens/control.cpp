// Siemens' controls: their own language and ISO mode, with corrections in the base frame in force.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/characters.hpp"
#include "nc/controls.hpp"
#include "nc/iso_reader.hpp"
#include "nc/siemens/reader.hpp"
#include "nc/written_words.hpp"

namespace driftwright {
namespace {

/// Corrections go into the active base frame, from the one that the operator has set:
/// `$P_BFRAME[X,TR]=$P_UBFR[X,TR]-0.0125`. Absolute: `$P_BFRAME[X,TR]=0.0125`.
/// Source: Siemens, SINUMERIK 840D sl, Function Manual Basic Functions, K2: frames in data management ($P_UBFR) and in force
/// ($P_BFRAME), which G54 or a reset loads anew.
class Siemens : public NcLanguage {
 public:
  std::vector<std::string> offset_lines(const NcOffsetOptions& options, const NcShift& shift) const override {
    const double unit_m = shift.before.unit_m;
    std::vector<std::string> lines;
    for (int axis = 0; axis < 3; ++axis) {
      if (!shift.axes[axis]) continue;
      const char letter = "XYZ"[axis];
      if (options.absolute) {
        lines.push_back(
            fmt::format("$P_BFRAME[{},TR]={}", letter, written_length(options.base_m[axis] + shift.to_m[axis], unit_m)));
      } else {
        const bool is_zero = written_length(shift.to_m[axis], unit_m) == "0";
        lines.push_back(fmt::format("$P_BFRAME[{},TR]=$P_UBFR[{},TR]{}", letter, letter,
                                    is_zero ? "" : signed_length(shift.to_m[axis], unit_m)));
      }
    }
    return lines;
  }

  std::string offset_name(const NcOffsetOptions& /*options*/) const override { return "The base frame"; }
  std::string remark(const NcOffsetOptions& /*options*/) const override {
    return "driftwright: corrections of drift in the base frame in force, added to the one that is set. A reset takes "
           "them away";
  }
  std::string advice(bool /*absolute*/) const override {
    return "Corrections go into the base frame in force ($P_BFRAME); the one that is set ($P_UBFR) and all work offsets "
           "stay, and a reset brings them back. "
           "Written by the maker's manuals: no SINUMERIK has run this program here; run it without a tool in the work "
           "first.";
  }
};

/// Siemens language mode (G290).
class SiemensLanguage final : public Siemens {
 public:
  std::string name() const override { return "Siemens (G290)"; }
  bool recognises(const std::vector<std::string>& /*lines*/) const override { return true; }
  void read(const std::string& path, const std::vector<std::string>& lines, NcExecution& run) const override {
    run_siemens_program(path, lines, run);
  }
  std::string remark_line(const std::string& text) const override { return "; " + text; }
  std::string unit_words() const override { return "G710 or G71"; }
};

/// ISO mode (G291): words as in RS-274; the lines of corrections are between G290 and G291.
class SiemensIso final : public Siemens {
 public:
  std::string name() const override { return "Siemens in ISO code (G291)"; }
  /// True if the program switches to ISO mode before its first motion.
  bool recognises(const std::vector<std::string>& lines) const override {
    for (std::string line : lines) {
      line.erase(std::min(line.find(';'), line.size()));
      line.erase(std::min(line.find('('), line.size()));
      line = upper_case(line);
      if (line.find("G291") != std::string::npos) return true;
      if (line.find('X') != std::string::npos || line.find('Z') != std::string::npos) return false;
    }
    return false;
  }
  void read(const std::string& path, const std::vector<std::string>& lines, NcExecution& run) const override {
    run_iso_program(path, lines, run, {.has_g291 = true, .work_offset_resets = true});
  }
  std::vector<std::string> offset_lines(const NcOffsetOptions& options, const NcShift& shift) const override {
    std::vector<std::string> lines = Siemens::offset_lines(options, shift);
    if (lines.empty()) return lines;
    lines.insert(lines.begin(), "G290");
    lines.emplace_back("G291");
    return lines;
  }
  std::string remark_line(const std::string& text) const override { return fmt::format("({})", text); }
  std::string unit_words() const override { return "G21 or G20"; }
};

}  // namespace

NcControl siemens_control() {
  static const SiemensIso iso;
  static const SiemensLanguage own;
  return {.key = "siemens",
          .title = "Siemens",
          .about = "its own language, or ISO after G291",
          .named_words = true,
          .languages = {&iso, &own}};
}

}  // namespace driftwright
