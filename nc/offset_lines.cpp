#include "nc/offset_lines.hpp"

#include <fmt/format.h>

#include <cmath>

#include "nc/units.hpp"

namespace driftwright {
namespace {

constexpr const char* kLetters = "XYZ";

/// "0.0125", "-3", "10": no trailing zeros, no exponent.
std::string number(double x_m, double unit_m) {
  std::string text = unit_m == kMillimetre_m ? fmt::format("{:.6f}", x_m / unit_m) : fmt::format("{:.7f}", x_m / unit_m);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

/// "+0.0125", "-3".
std::string with_sign(double x_m, double unit_m) {
  const std::string text = number(x_m, unit_m);
  return text.front() == '-' ? text : "+" + text;
}

/// The work offset's number P: 1 for G54 ... 9 for G59.3.
int offset_number(int system) {
  return system <= 590 ? (system - 540) / 10 + 1 : 6 + system - 590;
}

bool is_heidenhain(NcDialect dialect) {
  return dialect == NcDialect::kHeidenhainIso || dialect == NcDialect::kKlartext;
}

}  // namespace

double as_written_m(double x_m, double unit_m) {
  const double steps = unit_m == kMillimetre_m ? 1e6 : 1e7;
  return std::round(x_m / unit_m * steps) / steps * unit_m;
}

std::vector<std::string> offset_lines(const NcOffsetOptions& options, const std::array<bool, 3>& axes,
                                      const std::array<double, 3>& from_m, const std::array<double, 3>& to_m,
                                      const NcModes& before) {
  const double unit_m = before.unit_m;
  std::vector<std::string> lines;
  std::string words;
  switch (options.dialect) {
    case NcDialect::kLinuxCnc:
      if (options.shares_g92 && !options.absolute) {
        words = "G92";
        for (int axis = 0; axis < 3; ++axis) {  // the present position then has another number
          if (axes[axis] && to_m[axis] != from_m[axis])
            words += fmt::format(" {}[#{}{}]", kLetters[axis], 5420 + axis, with_sign(from_m[axis] - to_m[axis], unit_m));
        }
        if (words != "G92") lines.push_back(words);
        break;
      }
      words = options.absolute ? fmt::format("G10 L2 P{}", offset_number(options.work_offset)) : "G52";
      for (int axis = 0; axis < 3; ++axis) {
        if (axes[axis])
          words += fmt::format(" {}{}", kLetters[axis],
                               number((options.absolute ? options.base_m[axis] : 0.0) + to_m[axis], unit_m));
      }
      lines.push_back(words);
      break;
    case NcDialect::kSiemens:
    case NcDialect::kSiemensIso:
      for (int axis = 0; axis < 3; ++axis) {
        if (!axes[axis]) continue;
        const char letter = kLetters[axis];
        if (options.absolute) {
          lines.push_back(fmt::format("$P_BFRAME[{},TR]={}", letter, number(options.base_m[axis] + to_m[axis], unit_m)));
        } else {
          const std::string c = number(to_m[axis], unit_m) == "0" ? "" : with_sign(to_m[axis], unit_m);
          lines.push_back(fmt::format("$P_BFRAME[{},TR]=$P_UBFR[{},TR]{}", letter, letter, c));
        }
      }
      if (options.dialect == NcDialect::kSiemensIso && !lines.empty()) {
        lines.insert(lines.begin(), "G290");
        lines.emplace_back("G291");
      }
      break;
    case NcDialect::kHeidenhainIso:
      words = !options.absolute ? "G54 G91" : before.absolute ? "G54" : "G54 G90";
      for (int axis = 0; axis < 3; ++axis) {
        if (options.absolute && options.axes[axis]) {
          words += fmt::format(" {}{}", kLetters[axis], with_sign(options.base_m[axis] + to_m[axis], unit_m));
        } else if (!options.absolute && axes[axis] && to_m[axis] != from_m[axis]) {
          words += fmt::format(" {}{}", kLetters[axis], with_sign(to_m[axis] - from_m[axis], unit_m));
        }
      }
      if (words == "G54 G91") break;
      lines.push_back(words);
      if (options.absolute != before.absolute) lines.emplace_back(before.absolute ? "G90" : "G91");  // restores the mode
      break;
    case NcDialect::kKlartext: {
      lines.emplace_back("CYCL DEF 7.0 DATUM SHIFT");
      for (int axis = 0; axis < 3; ++axis) {
        const auto nth = lines.size();
        if (options.absolute && options.axes[axis]) {
          lines.push_back(
              fmt::format("CYCL DEF 7.{} {}{}", nth, kLetters[axis], with_sign(options.base_m[axis] + to_m[axis], unit_m)));
        } else if (!options.absolute && axes[axis] && to_m[axis] != from_m[axis]) {
          lines.push_back(
              fmt::format("CYCL DEF 7.{} I{}{}", nth, kLetters[axis], with_sign(to_m[axis] - from_m[axis], unit_m)));
        }
      }
      if (lines.size() == 1) lines.clear();
      break;
    }
  }
  return lines;
}

std::vector<std::string> guard_lines(const NcOffsetOptions& options) {
  if (options.dialect != NcDialect::kLinuxCnc || options.absolute || options.shares_g92) return {};
  std::string condition;
  const auto add = [&](const std::string& test) {
    condition = condition.empty() ? test : fmt::format("{} OR {}", condition, test);
  };
  for (int axis = 0; axis < 3; ++axis) {
    if (options.axes[axis]) add(fmt::format("[#{} NE 0]", 5211 + axis));
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

std::vector<std::string> straight_lines(NcDialect dialect, bool rapid, const std::array<std::optional<double>, 3>& to_m,
                                        const std::string& feed, const NcModes& before) {
  std::string line = dialect == NcDialect::kKlartext        ? "L"
                     : dialect == NcDialect::kHeidenhainIso ? (rapid ? "G00" : "G01")
                     : rapid                                ? "G0"
                                                            : "G1";
  for (int axis = 0; axis < 3; ++axis) {
    if (to_m[axis])
      line +=
          fmt::format(" {}{}", kLetters[axis],
                      is_heidenhain(dialect) ? with_sign(*to_m[axis], before.unit_m) : number(*to_m[axis], before.unit_m));
  }
  if (!feed.empty()) line += " " + feed;
  if (dialect == NcDialect::kKlartext) return {rapid ? line + " FMAX" : line};
  if (before.absolute) return {line};
  return {"G90 " + line, "G91"};
}

std::string remark_line(NcDialect dialect, const std::string& text) {
  return dialect == NcDialect::kLinuxCnc || dialect == NcDialect::kSiemensIso ? fmt::format("({})", text) : "; " + text;
}

}  // namespace driftwright
