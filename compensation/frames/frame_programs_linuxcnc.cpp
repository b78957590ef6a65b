#include <fmt/format.h>

#include <cmath>

#include "compensation/frames/frame_programs_text.hpp"

namespace driftwright::compensation {
namespace {

// A preview does not probe and must not stop with an error: #<_task> is 0 there. M66 waits for queued moves, which ABORT
// would drop.
std::string refusal(std::size_t label, const std::string& condition, const std::string& way_out, const std::string& words) {
  return fmt::format(
      "o{} if [[#<_task> EQ 1] AND [{}]]\n{}M72\nG54\nM66 E0 L0\n(ABORT, {}; the old G59.3 stays)\nM2\no{} endif\n", label,
      condition, way_out, words, label);
}

// Lengths and feeds, and no rounded corners: with G64 a way beside begins before the way up has ended. M73 and M72 give the
// user's modes back.
constexpr const char* kProbingModes = "G21 G90 G94 G17 G40 G61\n";

// Tool length and a system without offsets. G59.2 in inches tells the unit of the machine.
constexpr const char* kProbingSystem =
    "G43\n"
    "(#160: mm in the unit of the machine, which #5221 is in)\n"
    "G10 L2 P8 X25.4\n"
    "#160 = [25.4 / #5361]\n"
    "G10 L2 P8 X0 Y0 Z0 R0\n"
    "G59.2\n";

// Stores touches in #base .. #base + 4, the centre in #base + 5 and #base + 6. Never down before it is above the ring, and
// down and aside by touches: what is in the way stops them.
std::string ring_touches(const FrameProgram& p, const ProgramRing& ring, std::size_t base) {
  const auto& at = ring.at_m;
  const std::string up = fmt::format("G0 Z{}\n", mm(at[2] + p.clearance_m));
  const auto missing = [&](std::size_t i) {
    return refusal(base + i, "#5070 EQ 0", up, fmt::format("ring {} missing", ring.name));
  };
  const auto guarded = [&](std::size_t label, const std::string& end) {
    return fmt::format("G38.3 {} F{:.0f}\n", end, kWayDown_mm_min) +
           refusal(base + label, "#5070 EQ 1", up, fmt::format("something is in the way above ring {}", ring.name));
  };
  std::string text = fmt::format("(ring {})\no{} if [#<_z> LT {}]\n{}o{} endif\nG0 X{} Y{}\n{}", ring.name, base + 12,
                                 mm(at[2] + p.clearance_m), up, base + 12, mm(at[0]), mm(at[1]), up);
  text += guarded(13, "Z" + mm(at[2] - p.depth_m));
  for (std::size_t i = 0; i < 4; ++i) {
    const int axis = i < 2 ? 0 : 1;
    const double to_m = at[axis] + (i % 2 ? -1.0 : 1.0) * search_m(p);
    text += fmt::format("G38.3 {}{} F{:.0f}\n{}#{} = #{}\nG1 X{} Y{} F2000\n", "XY"[axis], mm(to_m), p.feed_mm_min,
                        missing(i), base + i, 5061 + axis, mm(at[0]), mm(at[1]));
  }
  text += fmt::format("G0 Z{}\n", mm(at[2] + 5e-3)) + guarded(14, "X" + mm(at[0] + 0.5 * p.free_diameter_m + 8e-3)) +
          fmt::format("G38.3 Z{} F{:.0f}\n{}", mm(at[2] - 3e-3), p.feed_mm_min, missing(4));
  text += fmt::format("(once more, slowly)\nG91 G1 Z{} F2000\nG90\nG38.3 Z{} F{:.0f}\n{}#{} = #5063\n{}", mm(kBackOff_m),
                      mm(at[2] - 3e-3), kSlowTouch * p.feed_mm_min, missing(11), base + 4, up);
  text += refusal(base + 7, fmt::format("ABS[#{} - {}] GT {:g}", base + 4, mm(at[2]), 1e3 * kMostRise_m), "",
                  fmt::format("height of ring {}: look at the length of the probe and the origin", ring.name));
  for (std::size_t side : {base, base + 2}) {
    text += refusal(side + 8, fmt::format("ABS[#{} - #{} - {}] GT 1", side, side + 1, mm(p.free_diameter_m)), "",
                    fmt::format("ring {} touched at the wrong side", ring.name));
  }
  return text + fmt::format("#{} = [[#{} + #{}] / 2]\n#{} = [[#{} + #{}] / 2]\n", base + 5, base, base + 1, base + 6,
                            base + 2, base + 3);
}

// The scale acts on the joint, after all offsets. G59.3 contains the shift before it, turned and moved as G54.
std::string linuxcnc_therm_frame(const FrameProgram& p) {
  const auto &a = p.rings[0].at_m, &b = p.rings[1].at_m;
  std::string text = fmt::format("(Driftwright: rings by G38.3, the thermal frame into G59.3)\n({})\n({})\n",
                                 last_numbers(p), origin_words(p));
  text +=
      "(G59.3 becomes G54 with the correction; G54 stays. Programs to be corrected run in G59.3; after a change of G54 run "
      "this anew)\n"
      "(G59.2 is used for probing. T and M6 of the probe first: its length comes from the tool table)\n"
      "M70\n";
  text += kProbingModes;
  text += refusal(90, fmt::format("#5400 NE {}", p.probe_tool), "",
                  fmt::format("no probe in the spindle, tool {} is required, the key tool of probe", p.probe_tool));
  text += refusal(92, "#<_spindle_on> EQ 1", "", "the spindle turns, M5 first");
  text += refusal(91, "#5210 EQ 1", "", "G92 is in force, G92.1 first");
  text += kProbingSystem;
  for (std::size_t r = 0; r < 2; ++r) text += ring_touches(p, p.rings[r], 100 + 20 * r);
  text += fmt::format("(TEMP_SCALE)\n#150 = [[#125 - #105] / {}]\n", mm(b[0] - a[0]));
  text += refusal(200, fmt::format("ABS[#150 - 1] GT {:.6f}", kMostScale), "",
                  "no temperature does that, or the rings are swapped");
  text += fmt::format("(TEMP_SHIFT)\n#151 = [#105 / #150 - {}]\n", mm(a[0]));
  text += fmt::format("(turn in degrees)\n#152 = [ATAN[#126 - #106]/[#125 - #105] - {:.9f}]\n",
                      kDegrees * std::atan2(b[1] - a[1], b[0] - a[0]));
  text +=
      fmt::format("(shift along y: what the turn leaves)\n#153 = [[#106 + #126] / 2 - {} - SIN[#152] * [#105 + #125] / 2]\n",
                  mm(0.5 * (a[1] + b[1])));
  text += fmt::format("(shift along z: the mean; LinuxCNC has no tilt)\n#154 = [[#104 + #124] / 2 - {}]\n",
                      mm(0.5 * (a[2] + b[2])));
  text +=
      "(G54 of the user, turned and shifted with the table)\n"
      "#155 = [#151 + #160 * [#5221 * COS[#152] - #5222 * SIN[#152]]]\n"
      "#156 = [#153 + #160 * [#5221 * SIN[#152] + #5222 * COS[#152]]]\n"
      "#157 = [#154 + #160 * #5223]\n"
      "#158 = [#152 + #5230]\n"
      "G10 L2 P9 X#155 Y#156 Z#157 R#158\n"
      "M72\n"
      "G54\n"
      "(the scale belongs into joint_0.comp, which is read as LinuxCNC starts)\n"
      "M2\n";
  return text;
}

// Trims [mm]: type 1 adds them to the joint's position.
std::string joint_trims(const FrameProgram& p) {
  std::string text;
  constexpr int kRows = 21;
  for (int i = 0; i < kRows; ++i) {
    const double x_m = p.low_m + (p.high_m - p.low_m) * i / (kRows - 1), trim_m = (p.frame.x.scale - 1.0) * x_m;
    text += fmt::format("{:.4f} {:.5f} {:.5f}\n", 1e3 * x_m, 1e3 * trim_m, 1e3 * trim_m);
  }
  return text;
}

// The end of the subprogram where a touch is refused. The program that calls it goes on, and may look at #<_value>.
std::string touch_refusal(const AxisProgram& p, int label, const std::string& condition, const std::string& way_out,
                          int status, const std::string& words) {
  return fmt::format(
      "o{} if [[#<_task> EQ 1] AND [{}]]\n{}M66 E0 L0\n(DEBUG, probing refused: {}. The last good offset stays)\n"
      "o<probe_{}> return [{}]\no{} endif\n",
      label, condition, way_out, words, small_letter_of(p), status, label);
}

// The offset into G59.1, and into G59.3 with the user's G54.
std::string offset_update(const AxisProgram& p, const std::string& way_out) {
  std::string text = fmt::format(
      "(the offset in force, and what it may change by)\n#<now> = [#160 * #{}]\n#<bound> = {}\no110 if [#<now> EQ 0]\n"
      "#<bound> = {}\no110 endif\n#<new> = [#<read> - {}]\n#<step_um> = [[#<new> - #<now>] * 1000]\n",
      5341 + p.axis, mm(1e-6 * p.step_um, 5), mm(1e-6 * p.first_um, 5), mm(p.at_m[p.axis]));
  text += touch_refusal(p, 111, "ABS[#<new> - #<now>] GT #<bound>", way_out, 4,
                        "too far from what is expected, by #<step_um> um, chips, another tool, or the axis was knocked. "
                        "Clean and probe again");
  text += touch_refusal(p, 112, fmt::format("ABS[#<new>] GT {}", mm(1e-6 * p.most_um, 5)), way_out, 4,
                        "the offset would pass its limit. Look at G59.1");
  text += fmt::format("G10 L2 P7 {}#<new>\nG10 L2 P9", letter_of(p));
  for (int axis = 0; axis < 3; ++axis) text += fmt::format(" {}[#160 * [#{} + #{}]]", "XYZ"[axis], 5221 + axis, 5341 + axis);
  return text + fmt::format(" R#5230\n{}(DEBUG, probing taken: {} by #<step_um> um)\n", way_out, letter_of(p));
}

// The value to the component; its verdict: 1 taken, 2 a jump, else refused. Strobe and value of the axes x, y, z are apart.
std::string value_for_component(const AxisProgram& p, const std::string& way_out) {
  std::string text = fmt::format(
      "#<left_um> = [[{} - #<read>] * 1000]\nM68 E{} Q#<left_um>\nM64 P{}\nG4 P0.1\nM65 P{}\nM66 E0 L0\n#<verdict> = 1\n"
      "o110 if [#<_task> EQ 1]\n#<verdict> = #<_hal[thermal.probe-verdict]>\no110 endif\n",
      mm(p.at_m[p.axis]), p.axis, p.axis, p.axis);
  text += touch_refusal(p, 111, "[#<verdict> LT 1] OR [#<verdict> GT 2]", way_out, 4,
                        "by the component, verdict #<verdict>, off by #<left_um> um. Clean and probe again");
  return text + fmt::format("{}(DEBUG, probing taken: {} was off by #<left_um> um)\n", way_out, letter_of(p));
}

}  // namespace

std::vector<ProgramFile> linuxcnc_axis(const AxisProgram& p) {
  const char letter = letter_of(p);
  const char small = small_letter_of(p);
  const Eigen::Vector3d from_m = before_touch_m(p);
  const std::string up = fmt::format("G0 Z{}\n", mm(p.at_m[2] + p.clearance_m));
  const std::string way_out = p.axis == 2 ? up : fmt::format("G1 {}{} F2000\n{}", letter, mm(from_m[p.axis]), up);
  std::string text = fmt::format("(Driftwright: touches a gauge along {}, and keeps its offset true)\n({})\n({})\n", letter,
                                 p.made_by, gauge_words(p));
  text += p.to_component
              ? fmt::format(
                    "(the component `thermal` of the model gets what is left: net left motion.analog-out-0{} => "
                    "thermal.probe-um, net touched motion.digital-out-0{} => thermal.probe-strobe)\n",
                    p.axis, p.axis)
              : fmt::format(
                    "({})\n(G59.1 has the offsets in force; G59.3 becomes G54 with them, and G54 stays. Programs to be "
                    "corrected run in G59.3; after a change of G54 run this anew)\n",
                    bound_words(p));
  text += fmt::format(
      "(G59.2 is used for probing. By o<probe_{0}> call, after T and M6 of the probe. #<_value>: 0 taken, 1 no probe, 2 "
      "G92, 3 no gauge, 4 refused, 5 something in the way, 6 the spindle turns)\n"
      "o<probe_{0}> sub\nM73\n",
      small);
  text += kProbingModes;
  if (p.to_component) text += fmt::format("M65 P{}\n", p.axis);
  text += touch_refusal(p, 100, fmt::format("#5400 NE {}", p.probe_tool), "", 1,
                        fmt::format("no probe in the spindle, tool {} is required", p.probe_tool));
  text += touch_refusal(p, 105, "#<_spindle_on> EQ 1", "", 6, "the spindle turns, M5 first");
  text += touch_refusal(p, 101, "#5210 EQ 1", "", 2, "G92 is in force, G92.1 first");
  text += kProbingSystem;
  text += fmt::format(
      "(never down before it is above the gauge, and down by a touch: what is in the way stops it)\n"
      "o106 if [#<_z> LT {}]\n{}o106 endif\nG0 X{} Y{}\n{}G38.3 Z{} F{:.0f}\n",
      mm(p.at_m[2] + p.clearance_m), up, mm(from_m[0]), mm(from_m[1]), up, mm(from_m[2]), kWayDown_mm_min);
  text += touch_refusal(p, 107, "#5070 EQ 1", way_out, 5, "something is in the way above the gauge");
  const auto touch = [&](double share, int label) {
    return fmt::format("G38.3 {}{} F{:g}\n", letter, mm(beyond_touch_m(p)), share * p.feed_mm_min) +
           touch_refusal(p, label, "#5070 EQ 0", way_out, 3, "no gauge");
  };
  text += touch(1.0, 102);
  text += fmt::format("(once more, slowly)\nG91 G1 {}{} F2000\nG90\n", letter, mm(-p.toward * kBackOff_m));
  text += touch(kSlowTouch, 103);
  text += fmt::format(
      "(a touch reads the place of the joint; the external offset of the axis is not its own)\n#<led> = 0\n"
      "o104 if [#<_task> EQ 1]\n#<led> = #<_hal[axis.{}.eoffset]>\no104 endif\n#<read> = [#{} - #160 * #<led>]\n",
      small, 5061 + p.axis);
  text += p.to_component ? value_for_component(p, way_out) : offset_update(p, way_out);
  return {{fmt::format("linuxcnc/probe_{}.ngc", small),
           text + fmt::format("o<probe_{0}> endsub [0]\no<probe_{0}> call\nM2\n", small)}};
}

std::vector<ProgramFile> linuxcnc_frame(const FrameProgram& p) {
  return {{"linuxcnc/thermframe.ngc", linuxcnc_therm_frame(p)}, {"linuxcnc/joint_0.comp", joint_trims(p)}};
}

}  // namespace driftwright::compensation
