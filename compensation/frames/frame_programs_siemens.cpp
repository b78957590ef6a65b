#include <fmt/format.h>

#include "base/quantity.hpp"
#include "compensation/frames/frame_programs_text.hpp"

namespace driftwright::compensation {
namespace {

// Where the tip of the probe is measured: no frame is in force, a probe is in the spindle and does not turn. A program with
// SAVE has its caller's frames back at its end. G60: with G64 a way beside begins before the way up has ended. Types of
// tools: 580 3D probe of lathes, 710 to 714 probes of mills.
std::string probe_without_frames() {
  std::string text =
      "IF $P_TOOL==0 GOTOF NOLENGTH\n"
      "G500 G90 G71 G94\n"
      "TRANS\n"
      "$P_BFRAME=CTRANS()\n";
  for (const char axis : {'X', 'Y', 'Z'})
    text += fmt::format(
        "IF ($P_ACTFRAME[{0},TR]<>0) OR ($P_ACTFRAME[{0},FI]<>0) OR ($P_ACTFRAME[{0},RT]<>0) OR ($P_ACTFRAME[{0},SC]<>1) OR "
        "($P_ACTFRAME[{0},MI]==TRUE) GOTOF OTHERFRAME\n",
        axis);
  return text +
         "IF ($TC_DP1[$P_TOOLNO,$P_TOOL]<>580) AND (($TC_DP1[$P_TOOLNO,$P_TOOL]<710) OR ($TC_DP1[$P_TOOLNO,$P_TOOL]>714)) "
         "GOTOF NOPROBE\n"
         "M5\n"
         "G17 G40 G60\n";
}

// Rapid motion to a place above what is touched.
std::string to_above(const std::string& x, const std::string& y, const std::string& high) {
  return fmt::format(
      "STOPRE\n"
      "IF $AA_IW[Z]>={2} GOTOF ABOVE           ; never down before it is above what is touched\n"
      "G0 Z={2}\n"
      "ABOVE:\n"
      "G0 X={0} Y={1}\n"
      "G0 Z={2}\n",
      x, y, high);
}

// A motion that contact ends. With a probe that is deflected already no edge comes, and the axis would move through.
std::string touch_to(const std::string& end, double feed_mm_min) {
  return fmt::format("STOPRE\nIF $A_PROBE[1]==1 GOTOF DEFLECTED\nMEAS=1 G1 {} F{:g}\nSTOPRE\n", end, feed_mm_min);
}

// A motion on which nothing may be touched.
std::string guarded_to(const std::string& end) {
  return touch_to(end, kWayDown_mm_min) + "IF $AC_MEA[1]==1 GOTOF INTHEWAY\n";
}

// A label at which a status is set. The alarm comes when the probe is away and all frames are back, because it may end the
// program.
std::string status_at(const char* status, const char* label, int alarm, const char* words, const char* next) {
  return fmt::format("{}:\n{}={}                         ; {}\nGOTOF {}\n", label, status, alarm, words, next);
}

// What ends a probing, whatever is touched.
std::string probe_refusals(const char* status, const char* above) {
  return status_at(status, "INTHEWAY", 65021, fmt::format("something is in the way above the {}", above).c_str(), "AWAY") +
         status_at(status, "DEFLECTED", 65022, "the probe is deflected, or not connected", "AWAY") +
         status_at(status, "NOLENGTH", 65015, "no D number: the length of the probe is required", "BACK") +
         status_at(status, "NOPROBE", 65023, "no probe in the spindle: tool type 580 or 710 to 714 is required", "BACK") +
         status_at(status, "OTHERFRAME", 65016, "a global, system or external frame is in force", "BACK");
}

// Jumps where lengths are read in inches: the program's positions are in mm.
constexpr const char* kNoInches =
    "IF ($MN_SCALING_SYSTEM_IS_METRIC==FALSE) OR ($P_GG[13]==1) OR ($P_GG[13]==3) GOTOF INCHES\n";
std::string inches(const char* status) {
  return status_at(status, "INCHES", 65024, "mm are required: a metric control, and G71 or G710", "REFUSED");
}

// Names start with TF_, because X1, Y1, Z1, I and TURN are names of axes, interpolation and helices. No SAVE here, because
// it would remove the new frame at the return; RINGMEAS has it, so that no G function of the caller changes.
std::string siemens_therm_frame(const FrameProgram& p) {
  const auto &a = p.rings[0].at_m, &b = p.rings[1].at_m;
  std::string text = fmt::format("PROC THERMFRAME(VAR INT TF_STATUS) DISPLOF\n; {}\n; {}\n; {}\n", p.made_by,
                                 last_numbers(p), origin_words(p));
  text += fmt::format(
      "; {}\n; and the control may refuse G2, G3 in X Y where factors differ. For such programs run THERMDATA in place of "
      "this: it moves the axis itself, after the interpolation,\n; where no arc is scaled\n",
      arc_words(p));
  text +=
      "; Call with the probe in the spindle and its D number active. TF_STATUS: 0, or the alarm; then the old frame stays.\n"
      "; The caller declares it: EXTERN THERMFRAME(VAR INT), DEF INT STATUS, THERMFRAME(STATUS), IF STATUS<>0 ...\n"
      "EXTERN RINGMEAS(REAL, REAL, REAL, VAR REAL, VAR REAL, VAR REAL, VAR INT)\n"
      "DEF REAL TF_X1, TF_Y1, TF_Z1, TF_X2, TF_Y2, TF_Z2, TF_X1N, TF_Y1N, TF_Z1N, TF_X2N, TF_Y2N, TF_Z2N\n"
      "DEF REAL TEMP_SCALE, TEMP_SHIFT, TF_TURN, TF_TILT\n"
      "DEF FRAME TF_OLD, TF_OLDDATA, TF_NEW\n";
  text += fmt::format("TF_X1={} TF_Y1={} TF_Z1={} TF_X2={} TF_Y2={} TF_Z2={}\n", mm(a[0]), mm(a[1]), mm(a[2]), mm(b[0]),
                      mm(b[1]), mm(b[2]));
  text += fmt::format(
      "STOPRE\n"
      "TF_OLD=$P_BFRAME\n"
      "TF_OLDDATA=$P_UBFR\n"
      "{}"
      "$P_UBFR=CTRANS()                        ; the old correction must not be measured again, nor come back with G500\n"
      "$P_BFRAME=CTRANS()\n"
      "RINGMEAS(TF_X1, TF_Y1, TF_Z1, TF_X1N, TF_Y1N, TF_Z1N, TF_STATUS)\n"
      "IF TF_STATUS<>0 GOTOF REFUSED\n"
      "RINGMEAS(TF_X2, TF_Y2, TF_Z2, TF_X2N, TF_Y2N, TF_Z2N, TF_STATUS)\n"
      "IF TF_STATUS<>0 GOTOF REFUSED\n"
      "IF ABS(TF_X2-TF_X1)<100 GOTOF IDENTICAL\n"
      "TEMP_SCALE=(TF_X2N-TF_X1N)/(TF_X2-TF_X1)\n"
      "IF TEMP_SCALE<0 GOTOF SWAPPED\n"
      "IF ABS(TEMP_SCALE-1)>{:g} GOTOF NOHEAT\n"
      "TEMP_SHIFT=TF_X1N/TEMP_SCALE-TF_X1\n"
      "TF_TURN=ATAN2(TF_Y2N-TF_Y1N, TF_X2N-TF_X1N)-ATAN2(TF_Y2-TF_Y1, TF_X2-TF_X1)\n"
      "TF_TILT=ATAN2(TF_Z2-TF_Z1, TF_X2-TF_X1)-ATAN2(TF_Z2N-TF_Z1N, TF_X2N-TF_X1N)\n"
      "; shift first, then scale, then tilt and turn; frames chain from right to left\n"
      "TF_NEW=CTRANS(Y,(TF_Y1N+TF_Y2N-TF_Y1-TF_Y2)/2-SIN(TF_TURN)*(TF_X1N+TF_X2N)/2,"
      "Z,(TF_Z1N+TF_Z2N-TF_Z1-TF_Z2)/2+SIN(TF_TILT)*(TF_X1N+TF_X2N)/2)"
      ":CROT(Z,TF_TURN,Y,TF_TILT):CSCALE(X,TEMP_SCALE):CTRANS(X,TEMP_SHIFT)\n"
      "$P_UBFR=TF_NEW                          ; data management, $P_CHBFR[0]: the next G54 would lose it else\n"
      "$P_BFRAME=TF_NEW\n"
      "STOPRE\n"
      "RET\n",
      kNoInches, kMostScale);
  const auto refusal = [](const char* label, int alarm, const char* words) {
    return status_at("TF_STATUS", label, alarm, words, "REFUSED");
  };
  text += refusal("IDENTICAL", 65010, "rings identical") + refusal("SWAPPED", 65011, "rings swapped") +
          refusal("NOHEAT", 65012, "no temperature does that") + inches("TF_STATUS");
  text +=
      "REFUSED:\n"
      "$P_UBFR=TF_OLDDATA\n"
      "$P_BFRAME=TF_OLD\n"
      "STOPRE\n"
      "SETAL(TF_STATUS)\n"
      "M0\n"
      "RET\n";
  return text;
}

std::string ring_measurement(const FrameProgram& p) {
  std::string text = fmt::format(
      "PROC RINGMEAS(REAL TF_CX, REAL TF_CY, REAL TF_CZ, VAR REAL TF_FX, VAR REAL TF_FY, VAR REAL TF_FZ, VAR INT TF_STATUS) "
      "SAVE "
      "DISPLOF\n; {}\n; Centre of a ring by four touches, its height by one on its edge; by the tip of the probe, without "
      "frames.\n",
      p.made_by);
  text +=
      "DEF REAL TF_WALL[4]\n"
      "TF_STATUS=0\n";
  const std::string high = "TF_CZ+" + mm(p.clearance_m, 3);
  text += probe_without_frames() + to_above("TF_CX", "TF_CY", high) + guarded_to("Z=TF_CZ-" + mm(p.depth_m, 3));
  const std::string missed = "IF $AC_MEA[1]==0 GOTOF NORING\n";
  const char* sides[4] = {"X=TF_CX+", "X=TF_CX-", "Y=TF_CY+", "Y=TF_CY-"};
  for (int i = 0; i < 4; ++i) {
    text += touch_to(sides[i] + mm(search_m(p), 3), p.feed_mm_min) + missed +
            fmt::format("TF_WALL[{}]=$AA_MW[{}]\nG1 X=TF_CX Y=TF_CY F2000\n", i, i < 2 ? 'X' : 'Y');
  }
  for (int i : {0, 2})
    text += fmt::format("IF ABS(TF_WALL[{}]-TF_WALL[{}]-{})>1 GOTOF WRONGSIDE\n", i, i + 1, mm(p.free_diameter_m, 3));
  text += "G0 Z=TF_CZ+5\n" + guarded_to("X=TF_CX+" + mm(0.5 * p.free_diameter_m + 8e-3, 3)) +
          touch_to("Z=TF_CZ-3", p.feed_mm_min) + missed +
          fmt::format("G91 G1 Z{} F2000\nG90\n; once more, slowly\n", mm(kBackOff_m, 3)) +
          touch_to("Z=TF_CZ-3", kSlowTouch * p.feed_mm_min) + missed +
          fmt::format("IF ABS($AA_MW[Z]-TF_CZ)>{:g} GOTOF WRONGHEIGHT\n", 1e3 * kMostRise_m);
  text += "TF_FX=(TF_WALL[0]+TF_WALL[1])/2\nTF_FY=(TF_WALL[2]+TF_WALL[3])/2\nTF_FZ=$AA_MW[Z]\nGOTOF AWAY\n";
  const auto refusal = [](const char* label, int alarm, const char* words) {
    return status_at("TF_STATUS", label, alarm, words, "AWAY");
  };
  text += refusal("NORING", 65013, "ring missing") + refusal("WRONGSIDE", 65014, "touched at the wrong side") +
          refusal("WRONGHEIGHT", 65017, "height: look at the length of the probe and the origin") +
          probe_refusals("TF_STATUS", "ring");
  return text + fmt::format("AWAY:\nG0 Z={}\nBACK:\nSTOPRE\nRET\n", high);
}

std::string setting_data(const FrameProgram& p) {
  const AxisTemperatureData data = data_at(p.control, p.temperature_K);
  const double sign = p.against_dk ? -1.0 : 1.0;
  const char sign_word = p.against_dk ? '-' : '+';
  std::string text = fmt::format(
      "; {}\n; Temperature compensation of X at {:.1f} degC: dK = K0 + tan_beta (P - P0), the axis moves by {}dK.\n",
      p.made_by, p.temperature_K - kZeroCelsius_K, sign_word);
  text += fmt::format(
      "; The sign is the scenario's (axis_moves); the manual does not give it. Check: SD43900=0.1, a dial gauge on the axis "
      "at rest must go 0.1 mm\n; toward {}X; else set axis_moves: {} and write this file anew.\n",
      sign_word, p.against_dk ? "by_dk" : "against_dk");
  if (const std::string limit = limit_words(p); !limit.empty()) text += limit + "\n";
  text += fmt::format(
      "; tan_beta = {:.3f}e-6 /K (T - {:.2f} degC), K0 = {} mm {:+.6f} mm/K (T - T0); write both anew as T changes\n",
      sign * 1e6 * p.control.slope_1_K, p.control.reference_K - kZeroCelsius_K, mm(sign * p.control.k0_m),
      sign * 1e3 * p.control.k0_m_K);
  text += fmt::format(
      "; MD32760: {:g} of MD32000 {:.0f} mm/min, so that the axis follows at {:.0f} mm/min at most\n"
      "; MD32750 acts after power-on only, MD32760 after NEWCONF; the setting data act at once. P0 is a machine coordinate\n"
      "IF $MN_SCALING_SYSTEM_IS_METRIC==FALSE GOTOF INCHES\n"
      "$MA_TEMP_COMP_TYPE[AX1]=3               ; MD32750: K0 and tan_beta\n"
      "$MA_COMP_ADD_VELO_FACTOR[AX1]={:g}     ; MD32760\n"
      "NEWCONF\n"
      "$SA_TEMP_COMP_ABS_VALUE[AX1]={}     ; SD43900, K0 [mm]\n"
      "$SA_TEMP_COMP_SLOPE[AX1]={:.6f}       ; SD43910, tan_beta\n"
      "$SA_TEMP_COMP_REF_POSITION[AX1]={}  ; SD43920, P0 [mm]\n"
      "M17\n"
      "INCHES:\n"
      "SETAL(65024)                            ; mm are required: a metric control\n"
      "M17\n",
      p.slew, 6e4 * p.velocity_m_s, 6e4 * p.velocity_m_s * p.slew, p.slew, mm(sign * data.absolute_m, 3),
      sign * data.slope + 0.0, mm(data.reference_m, 3));
  return text;
}

// The touch, with SAVE: frames and G functions of the caller come back. The position of the tip is in TA_READ.
std::string siemens_touch(const AxisProgram& p) {
  const char letter = letter_of(p);
  const Eigen::Vector3d from_m = before_touch_m(p);
  const std::string high = mm(p.at_m[2] + p.clearance_m), to = fmt::format("{}={}", letter, mm(beyond_touch_m(p)));
  std::string text = fmt::format("PROC TOUCH{}(VAR REAL TA_READ, VAR INT TA_STATUS) SAVE DISPLOF\n; {}\n; {}\nTA_STATUS=0\n",
                                 letter, p.made_by, gauge_words(p));
  text += probe_without_frames() + to_above(mm(from_m[0]), mm(from_m[1]), high);
  const std::string missed = "IF $AC_MEA[1]==0 GOTOF NOGAUGE\n";
  text += guarded_to("Z=" + mm(from_m[2])) + touch_to(to, p.feed_mm_min) + missed +
          fmt::format("G91 G1 {}={} F2000\nG90\n; once more, slowly\n", letter, mm(-p.toward * kBackOff_m)) +
          touch_to(to, kSlowTouch * p.feed_mm_min) + missed + fmt::format("TA_READ=$AA_MW[{}]\nGOTOF AWAY\n", letter);
  text += status_at("TA_STATUS", "NOGAUGE", 65018, "no gauge", "AWAY") + probe_refusals("TA_STATUS", "gauge");
  text += "AWAY:\n";
  if (p.axis != 2) text += fmt::format("G1 {}={} F2000\n", letter, mm(from_m[p.axis]));
  return text + fmt::format("G0 Z={}\nBACK:\nSTOPRE\nRET\n", high);
}

// The offset is written after all checks, to data management first: a reset before that loads the last good one. The alarm
// is the last block, because it may end the program. A caller in inches would have the offset in inches.
std::string siemens_update(const AxisProgram& p) {
  const char letter = letter_of(p);
  std::string text = fmt::format("PROC PROBE{}(VAR INT PA_STATUS) DISPLOF\n; {}\n; {}\n", letter, p.made_by, bound_words(p));
  text += fmt::format(
      "; Call with the probe in the spindle and its D number active. PA_STATUS: 0, or the alarm; then the last good offset "
      "stays.\n"
      "; The caller declares it: EXTERN PROBE{0}(VAR INT), DEF INT STATUS, PROBE{0}(STATUS), IF STATUS<>0 ...\n"
      "; The offset is the fine part of the base frame, added to its coarse part: $P_UBFR[{0},FI]. MD18600 must be 1.\n"
      "EXTERN TOUCH{0}(VAR REAL, VAR INT)\n"
      "DEF REAL PA_READ, PA_NEW, PA_NOW, PA_STEP, PA_BOUND\n"
      "DEF FRAME PA_FRAME\n"
      "STOPRE\n"
      "PA_FRAME=$P_BFRAME\n"
      "{5}"
      "PA_NOW=$P_UBFR[{0},FI]\n"
      "TOUCH{0}(PA_READ, PA_STATUS)\n"
      "IF PA_STATUS<>0 GOTOF REFUSED\n"
      "PA_NEW=PA_READ-({1})\n"
      "PA_BOUND={2}\n"
      "IF PA_NOW<>0 GOTOF INFORCE\n"
      "PA_BOUND={3}                            ; none is in force\n"
      "INFORCE:\n"
      "PA_STEP=PA_NEW-PA_NOW\n"
      "MSG(\"touch of {0}: \"<<PA_STEP<<\" mm from the offset in force\")\n"
      "IF ABS(PA_STEP)>PA_BOUND GOTOF TOOFAR\n"
      "IF ABS(PA_NEW)>{4} GOTOF TOOMUCH\n"
      "STOPRE\n"
      "$P_UBFR[{0},FI]=PA_NEW                   ; data management: the next G54 would lose it else\n"
      "PA_FRAME[{0},FI]=PA_NEW\n"
      "$P_BFRAME=PA_FRAME\n"
      "STOPRE\n"
      "RET\n",
      letter, mm(p.at_m[p.axis]), mm(1e-6 * p.step_um, 5), mm(1e-6 * p.first_um, 5), mm(1e-6 * p.most_um, 5), kNoInches);
  text += status_at("PA_STATUS", "TOOFAR", 65019,
                    "too far from what is expected: chips, another tool, or the axis was knocked. Clean and probe again",
                    "REFUSED") +
          status_at("PA_STATUS", "TOOMUCH", 65020, "the offset would pass its limit", "REFUSED") + inches("PA_STATUS");
  return text + "REFUSED:\n$P_BFRAME=PA_FRAME\nSTOPRE\nSETAL(PA_STATUS)\nRET\n";
}

}  // namespace

std::vector<ProgramFile> siemens_axis(const AxisProgram& p) {
  return {{fmt::format("siemens/PROBE{}.SPF", letter_of(p)), siemens_update(p)},
          {fmt::format("siemens/TOUCH{}.SPF", letter_of(p)), siemens_touch(p)}};
}

std::vector<ProgramFile> siemens_frame(const FrameProgram& p) {
  return {{"siemens/THERMFRAME.SPF", siemens_therm_frame(p)},
          {"siemens/RINGMEAS.SPF", ring_measurement(p)},
          {"siemens/THERMDATA.SPF", setting_data(p)}};
}

}  // namespace driftwright::compensation
