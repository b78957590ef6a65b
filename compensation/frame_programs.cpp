#include "compensation/frame_programs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "base/quantity.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

std::string mm(double m, int decimals = 4) {
  const std::string text = fmt::format("{:.{}f}", 1e3 * m, decimals);
  return text.find_first_not_of("-0.") == std::string::npos ? "0." + std::string(static_cast<std::size_t>(decimals), '0')
                                                            : text;
}

double search_m(const FrameProgram& p) {  // beyond the wall
  return 0.5 * p.free_diameter_m + 3e-3;
}

std::string last_numbers(const FrameProgram& p) {
  return fmt::format("last: TEMP_SCALE {:.9f}, TEMP_SHIFT {} mm, shift y {} mm, z {} mm, turn {:.7f} deg, tilt {:.7f} deg",
                     p.frame.x.scale, mm(p.frame.x.shift_m), mm(p.frame.shift_y_m), mm(p.frame.shift_z_m),
                     kDegrees * p.frame.turn_rad, kDegrees * p.frame.tilt_rad);
}

}  // namespace

std::vector<ProgramFile> siemens_frame(const FrameProgram& p) {
  const auto &a = p.rings[0].at_m, &b = p.rings[1].at_m;
  const double travel_m = search_m(p);
  std::string frame = fmt::format("; {}\n; {}\n", p.made_by, last_numbers(p));
  frame += "; Rings as they lay at the reference temperature, in basic coordinates without any frame [mm].\n";
  frame +=
      "PROC THERMFRAME SAVE DISPLOF\n"
      "DEF REAL X1, Y1, Z1, X2, Y2, Z2, X1N, Y1N, Z1N, X2N, Y2N, Z2N\n"
      "DEF REAL TEMP_SCALE, TEMP_SHIFT, TURN, TILT, FOUND[3]\n";
  frame += fmt::format("X1={} Y1={} Z1={} X2={} Y2={} Z2={}\n", mm(a[0]), mm(a[1]), mm(a[2]), mm(b[0]), mm(b[1]), mm(b[2]));
  frame +=
      "G500 G90 G71 G94\n"
      "TRANS\n"
      "$P_BFRAME=CTRANS()                      ; the old correction must not be measured again\n"
      "RINGMEAS(X1, Y1, Z1, FOUND)\n"
      "X1N=FOUND[0] Y1N=FOUND[1] Z1N=FOUND[2]\n"
      "RINGMEAS(X2, Y2, Z2, FOUND)\n"
      "X2N=FOUND[0] Y2N=FOUND[1] Z2N=FOUND[2]\n"
      "IF ABS(X2-X1)<100\n"
      "  SETAL(65010)                          ; rings identical\n"
      "  M0\n"
      "  RET\n"
      "ENDIF\n"
      "TEMP_SCALE=(X2N-X1N)/(X2-X1)\n"
      "IF TEMP_SCALE<0\n"
      "  SETAL(65011)                          ; rings swapped\n"
      "  M0\n"
      "  RET\n"
      "ENDIF\n";
  frame += fmt::format("IF ABS(TEMP_SCALE-1)>{:g}\n", kMostScale);
  frame +=
      "  SETAL(65012)                          ; no temperature does that\n"
      "  M0\n"
      "  RET\n"
      "ENDIF\n"
      "TEMP_SHIFT=X1N/TEMP_SCALE-X1\n"
      "TURN=ATAN2(Y2N-Y1N, X2N-X1N)-ATAN2(Y2-Y1, X2-X1)\n"
      "TILT=ATAN2(Z2-Z1, X2-X1)-ATAN2(Z2N-Z1N, X2N-X1N)\n"
      "; shift first, then scale, then tilt and turn; frames chain from right to left\n"
      "$P_BFRAME=CTRANS(Y,(Y1N+Y2N-Y1-Y2)/2-SIN(TURN)*(X1N+X2N)/2,Z,(Z1N+Z2N-Z1-Z2)/2+SIN(TILT)*(X1N+X2N)/2)"
      ":CROT(Z,TURN,Y,TILT):CSCALE(X,TEMP_SCALE):CTRANS(X,TEMP_SHIFT)\n"
      "STOPRE\n"
      "RET\n";
  std::string ring = fmt::format("; {}\n; Centre of a ring by four touches, its height by one on its edge.\n", p.made_by);
  ring +=
      "PROC RINGMEAS(REAL CX, REAL CY, REAL CZ, VAR REAL FOUND[3]) SAVE DISPLOF\n"
      "DEF REAL WALL[4]\n"
      "DEF INT I\n";
  ring += fmt::format("G0 SUPA Z=CZ+{}\nG0 X=CX Y=CY\nG1 Z=CZ-{} F2000\n", mm(p.clearance_m, 3), mm(p.depth_m, 3));
  const char* sides[4] = {"X=CX+", "X=CX-", "Y=CY+", "Y=CY-"};
  for (int i = 0; i < 4; ++i) {
    ring += fmt::format(
        "MEAS=1 G1 {}{} F{:.0f}\nSTOPRE\nIF $AC_MEA[1]==0\n  SETAL(65013)                          ; ring missing\n  M0\n  "
        "RET\nENDIF\nWALL[{}]=$AA_MM[{}]\nG1 X=CX Y=CY F2000\n",
        sides[i], mm(travel_m, 3), p.feed_mm_min, i, i < 2 ? 'X' : 'Y');
  }
  ring += fmt::format(
      "I=0\nWHILE I<4\n  IF ABS(WALL[I]-WALL[I+1]-{})>1\n    SETAL(65014)                        ; touched at the wrong "
      "side\n    M0\n    RET\n  ENDIF\n  I=I+2\nENDWHILE\n",
      mm(p.free_diameter_m, 3));
  ring += fmt::format(
      "FOUND[0]=(WALL[0]+WALL[1])/2\nFOUND[1]=(WALL[2]+WALL[3])/2\nG0 Z=CZ+5\nG0 X=CX+{}\nMEAS=1 G1 Z=CZ-3 "
      "F{:.0f}\nSTOPRE\nIF "
      "$AC_MEA[1]==0\n  SETAL(65013)\n  M0\n  RET\nENDIF\nFOUND[2]=$AA_MM[Z]\nG0 Z=CZ+{}\nRET\n",
      mm(0.5 * p.free_diameter_m + 8e-3, 3), p.feed_mm_min, mm(p.clearance_m, 3));
  const AxisTemperatureData data = data_at(p.control, p.temperature_K);
  std::string setting = fmt::format(
      "; {}\n; Temperature compensation of X at {:.1f} degC: dK = K0 + tan_beta (P - P0), the axis moves by -dK.\n",
      p.made_by, p.temperature_K - kZeroCelsius_K);
  setting += fmt::format(
      "; tan_beta = {:.3f}e-6 /K (T - {:.2f} degC), K0 = {} mm {:+.6f} mm/K (T - T0); write both anew as T changes\n",
      1e6 * p.control.slope_1_K, p.control.reference_K - kZeroCelsius_K, mm(p.control.k0_m), 1e3 * p.control.k0_m_K);
  setting += fmt::format(
      "; MD32760: {:g} of MD32000 {:.0f} mm/min, so that the axis follows at {:.0f} mm/min at most\n"
      "$MA_TEMP_COMP_TYPE[AX1]=3               ; MD32750: K0 and tan_beta\n"
      "$MA_COMP_ADD_VELO_FACTOR[AX1]={:g}     ; MD32760\n"
      "$SA_TEMP_COMP_ABS_VALUE[AX1]={}     ; SD43900, K0 [mm]\n"
      "$SA_TEMP_COMP_SLOPE[AX1]={:.6f}       ; SD43910, tan_beta\n"
      "$SA_TEMP_COMP_REF_POSITION[AX1]={}  ; SD43920, P0 [mm]\n"
      "M17\n",
      p.slew, 6e4 * p.velocity_m_s, 6e4 * p.velocity_m_s * p.slew, p.slew, mm(data.absolute_m, 3), data.slope,
      mm(data.reference_m, 3));
  return {{"siemens/THERMFRAME.SPF", frame}, {"siemens/RINGMEAS.SPF", ring}, {"siemens/THERMDATA.SPF", setting}};
}

std::vector<ProgramFile> linuxcnc_frame(const FrameProgram& p) {
  std::string text = fmt::format(
      "(Driftwright: rings by G38.2, the thermal frame into G54)\n({})\n(a preview touches nothing: #<_task> is 0 there)\n",
      last_numbers(p));  // parentheses end a comment, so none may stand in it
  text += "G21 G90 G94 G17 G40 G49\n(G59.3 without offset: machine coordinates)\nG10 L2 P9 X0 Y0 Z0 R0\nG59.3\n";
  for (std::size_t r = 0; r < 2; ++r) {
    const auto& at = p.rings[r].at_m;
    const std::size_t base = 100 + 20 * r;
    text += fmt::format("(ring {})\nG0 Z{}\nG0 X{} Y{}\nG1 Z{} F2000\n", p.rings[r].name, mm(at[2] + p.clearance_m),
                        mm(at[0]), mm(at[1]), mm(at[2] - p.depth_m));
    for (int i = 0; i < 4; ++i) {
      const int axis = i / 2;
      const double to_m = at[axis] + (i % 2 ? -1.0 : 1.0) * search_m(p);
      text += fmt::format("G38.2 {}{} F{:.0f}\n#{} = #{}\nG1 X{} Y{} F2000\n", "XY"[axis], mm(to_m), p.feed_mm_min,
                          base + static_cast<std::size_t>(i), 5061 + axis, mm(at[0]), mm(at[1]));
    }
    text += fmt::format("G0 Z{}\n", mm(at[2] + 5e-3));
    text += fmt::format("G0 X{}\nG38.2 Z{} F{:.0f}\n#{} = #5063\nG0 Z{}\n", mm(at[0] + 0.5 * p.free_diameter_m + 8e-3),
                        mm(at[2] - 3e-3), p.feed_mm_min, base + 4, mm(at[2] + p.clearance_m));
    text += fmt::format("#{} = [[#{} + #{}] / 2]\n#{} = [[#{} + #{}] / 2]\n", base + 5, base, base + 1, base + 6, base + 2,
                        base + 3);
    for (std::size_t side : {base, base + 2}) {
      text += fmt::format(
          "o{} if [[#<_task> EQ 1] AND [ABS[#{} - #{} - {}] GT 1]]\n(ABORT, touched at the wrong side)\nM2\no{} endif\n",
          side, side, side + 1, mm(p.free_diameter_m), side);
    }
  }
  const auto &a = p.rings[0].at_m, &b = p.rings[1].at_m;
  text += fmt::format("(TEMP_SCALE)\n#150 = [[#125 - #105] / {}]\n", mm(b[0] - a[0]));
  text += fmt::format(
      "o200 if [[#<_task> EQ 1] AND [ABS[#150 - 1] GT {:.6f}]]\n(ABORT, no temperature does that, or the rings are "
      "swapped)\nM2\no200 endif\n",
      kMostScale);
  text += fmt::format("(TEMP_SHIFT)\n#151 = [#105 / #150 - {}]\n", mm(a[0]));
  text += fmt::format("(turn in degrees)\n#152 = [ATAN[#126 - #106]/[#125 - #105] - {:.9f}]\n",
                      kDegrees * std::atan2(b[1] - a[1], b[0] - a[0]));
  text +=
      fmt::format("(shift along y: what the turn leaves)\n#153 = [[#106 + #126] / 2 - {} - SIN[#152] * [#105 + #125] / 2]\n",
                  mm(0.5 * (a[1] + b[1])));
  text += fmt::format("(shift along z: the mean; LinuxCNC has no tilt)\n#154 = [[#104 + #124] / 2 - {}]\n",
                      mm(0.5 * (a[2] + b[2])));
  text +=
      "G10 L2 P1 X#151 Y#153 Z#154 R#152\nG54\n(the scale belongs into joint_0.comp, which is read as LinuxCNC "
      "starts)\nM2\n";
  // Trims [mm]: type 1 adds them to the joint's position.
  std::string comp;
  constexpr int kRows = 21;
  for (int i = 0; i < kRows; ++i) {
    const double x_m = p.low_m + (p.high_m - p.low_m) * i / (kRows - 1), trim_m = (p.frame.x.scale - 1.0) * x_m;
    comp += fmt::format("{:.4f} {:.5f} {:.5f}\n", 1e3 * x_m, 1e3 * trim_m, 1e3 * trim_m);
  }
  return {{"linuxcnc/thermframe.ngc", text}, {"linuxcnc/joint_0.comp", comp}};
}

std::vector<ProgramFile> heidenhain_frame(const FrameProgram& p) {
  const auto &a = p.rings[0].at_m, &b = p.rings[1].at_m;
  std::vector<std::string> blocks = {"BEGIN PGM THERMFRAME MM", "; " + p.made_by, "; " + last_numbers(p)};
  const auto add = [&](std::string block) { blocks.push_back(std::move(block)); };
  for (const char* block :
       {"CYCL DEF 7.0 DATUM SHIFT", "CYCL DEF 7.1 X+0", "CYCL DEF 7.2 Y+0", "CYCL DEF 7.3 Z+0", "CYCL DEF 10.0 ROTATION",
        "CYCL DEF 10.1 ROT+0", "CYCL DEF 26.0 AXIS-SPEC. SCALING", "CYCL DEF 26.1 X1 CCX+0 CCY+0"})
    add(block);
  for (std::size_t r = 0; r < 2; ++r) {
    const auto& at = p.rings[r].at_m;
    add(fmt::format(
        "TCH PROBE 421 MEASURE HOLE ~ Q273={:+.4f} ~ Q274={:+.4f} ~ Q262=+{} ~ Q325=+0 ~ Q247=+90 ~ Q261={:+.4f} ~ Q320=+2 "
        "~ "
        "Q260={:+.4f} ~ Q301=+0 ~ Q275=+0 ~ Q276=+0 ~ Q279=+0 ~ Q280=+0 ~ Q281=+1 ~ Q309=+0 ~ Q330=+0",
        1e3 * at[0], 1e3 * at[1], mm(p.free_diameter_m, 3), 1e3 * (at[2] - p.depth_m), 1e3 * (at[2] + p.clearance_m)));
    add(fmt::format("FN 0: Q{} = Q151", 1 + 10 * r));
    add(fmt::format("FN 0: Q{} = Q152", 2 + 10 * r));
  }
  add(fmt::format("Q20 = ( Q11 - Q1 ) / {}", mm(b[0] - a[0])));
  add(fmt::format("FN 11: IF +Q20 GT +{:.6f} GOTO LBL 99", 1.0 + kMostScale));
  add(fmt::format("FN 12: IF +Q20 LT +{:.6f} GOTO LBL 99", 1.0 - kMostScale));
  add(fmt::format("Q21 = Q1 / Q20 - ( {} )", mm(a[0])));
  add(fmt::format("Q22 = ATAN ( ( Q12 - Q2 ) / ( Q11 - Q1 ) ) - ( {:.9f} )",
                  kDegrees * std::atan2(b[1] - a[1], b[0] - a[0])));
  add(fmt::format("Q23 = ( Q2 + Q12 ) / 2 - ( {} ) - SIN Q22 * ( Q1 + Q11 ) / 2", mm(0.5 * (a[1] + b[1]))));
  for (const char* block :
       {"CYCL DEF 7.0 DATUM SHIFT", "CYCL DEF 7.1 X+Q21", "CYCL DEF 7.2 Y+Q23", "CYCL DEF 10.0 ROTATION",
        "CYCL DEF 10.1 ROT+Q22", "CYCL DEF 26.0 AXIS-SPEC. SCALING", "CYCL DEF 26.1 XQ20 CCX+0 CCY+0",
        "FN 9: IF +0 EQU +0 GOTO LBL 100", "LBL 99", "FN 14: ERROR = 1000", "LBL 100", "END PGM THERMFRAME MM"})
    add(block);
  std::string text;
  for (std::size_t i = 0; i < blocks.size(); ++i) text += fmt::format("{} {}\n", i, blocks[i]);
  return {{"heidenhain/THERMFRAME.H", text}};
}

std::vector<ProgramFile> frame_programs(const FrameProgram& program) {
  if (program.rings.size() != 2) throw std::logic_error("frame_programs: two rings are wanted");
  std::vector<ProgramFile> files = siemens_frame(program);
  for (const auto& more : {linuxcnc_frame(program), heidenhain_frame(program)})
    files.insert(files.end(), more.begin(), more.end());
  return files;
}

}  // namespace driftwright::compensation
