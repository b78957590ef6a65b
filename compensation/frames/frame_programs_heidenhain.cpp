#include <fmt/format.h>

#include <cmath>

#include "compensation/frames/frame_programs_text.hpp"

namespace driftwright::compensation {
namespace {

std::string numbered(const std::vector<std::string>& blocks) {
  std::string text;
  for (std::size_t i = 0; i < blocks.size(); ++i) text += fmt::format("{} {}\n", i, blocks[i]);
  return text;
}

}  // namespace

// The cycle measures against the datum shift in force, which FN 18 reads: their sum does not depend on it. The change is
// added to this shift, so that one of the program's own stays.
std::vector<ProgramFile> heidenhain_axis(const AxisProgram& p) {
  const char letter = letter_of(p);
  const int kept = 46 + p.axis, shift = 50 + p.axis;
  const auto place = [&](int axis, double m) {
    return fmt::format("FN 2: Q{} = {:+.4f} - +Q{}", 53 + axis, 1e3 * m, 50 + axis);
  };
  const Eigen::Vector3d& at = p.at_m;
  std::vector<std::string> blocks = {
      fmt::format("BEGIN PGM PROBE{} MM", letter),
      "; " + p.made_by,
      "; " + gauge_words(p),
      "; " + bound_words(p),
      fmt::format("; By PGM CALL, with the probe called and the preset at machine zero, without rotation. Q{} keeps the "
                  "offset in force: a program that is selected anew",
                  kept),
      fmt::format("; adds it once, after datum shifts of its own: CYCL DEF 7.0 DATUM SHIFT, CYCL DEF 7.1 I{}+Q{}", letter,
                  kept),
      "; Q59 is 0, or 1 where a touch was refused; then, and where the control itself stops in a touch, the last good "
      "offset "
      "stays",
      "FN 0: Q59 = +1",
      "FN 18: SYSREAD Q50 = ID220 NR2 IDX1",
      "FN 18: SYSREAD Q51 = ID220 NR2 IDX2",
      "FN 18: SYSREAD Q52 = ID220 NR2 IDX3",
      place(0, at[0]),
      place(1, at[1]),
      place(2, at[2]),
      fmt::format("FN 1: Q56 = +Q55 + {:+.4f}", 1e3 * p.clearance_m),
      fmt::format("TCH PROBE 427 MEASURE COORDINATE ~\n    Q263=+Q53 ~\n    Q264=+Q54 ~\n    Q261=+Q55 ~\n"
                  "    Q320={:+.3f} ~\n    Q272={:+d} ~\n    Q267={:+d} ~\n    Q260=+Q56 ~\n    Q281=+0 ~\n    Q288=+0 ~\n"
                  "    Q289=+0 ~\n    Q309=+0 ~\n    Q330=+0",
                  1e3 * kBeforeTouch_m, p.axis + 1, p.toward > 0.0 ? 1 : -1),
      fmt::format("Q57 = Q160 + Q{} - ( {} ) - Q{}", shift, mm(at[p.axis]), kept),
      "Q58 = ABS Q57",
      fmt::format("FN 0: Q60 = {:+.5f}", 1e-3 * p.step_um),
      fmt::format("FN 10: IF +Q{} NE +0 GOTO LBL 1", kept),
      fmt::format("FN 0: Q60 = {:+.5f}", 1e-3 * p.first_um),
      "LBL 1",
      "FN 11: IF +Q58 GT +Q60 GOTO LBL 99",
      fmt::format("Q61 = ABS ( Q{} + Q57 )", kept),
      fmt::format("FN 11: IF +Q61 GT {:+.5f} GOTO LBL 99", 1e-3 * p.most_um),
      fmt::format("FN 1: Q{0} = +Q{0} + +Q57", kept),
      "CYCL DEF 7.0 DATUM SHIFT",
      fmt::format("CYCL DEF 7.1 I{}+Q57", letter),
      "FN 0: Q59 = +0",
      "LBL 99",
      fmt::format("END PGM PROBE{} MM", letter)};
  return {{fmt::format("heidenhain/PROBE{}.H", letter), numbered(blocks)}};
}

std::vector<ProgramFile> heidenhain_frame(const FrameProgram& p) {
  const auto &a = p.rings[0].at_m, &b = p.rings[1].at_m;
  const double bore_mm = 1e3 * (p.free_diameter_m + p.ball_diameter_m);  // the cycle itself subtracts the ball
  std::vector<std::string> blocks = {"BEGIN PGM THERMFRAME MM", "; " + p.made_by, "; " + last_numbers(p),
                                     "; " + origin_words(p), "; " + arc_words(p)};
  const auto add = [&](std::string block) { blocks.push_back(std::move(block)); };
  for (const char* block :
       {"; By PGM CALL, with the probe called and the datum at machine zero. Q40 to Q43 keep the frame in force",
        "; X alone is scaled (cycle 26), and this control requires equal factors in the plane of arcs: programs with C, CR, "
        "CT, CP or CC in X Y need Q45 = 1,",
        "; which scales Y alike about the rings' Y: right for a table that grows evenly, else an error of Y by that factor "
        "away from there",
        "; If the control itself stops in a touch no frame is in force: call again, or set cycles 7, 10, 26 to Q40 to Q43",
        "FN 10: IF +Q42 NE +0 GOTO LBL 1", "FN 0: Q42 = +1", "LBL 1", "FN 0: Q44 = +1", "CYCL DEF 7.0 DATUM SHIFT",
        "CYCL DEF 7.1 X+0", "CYCL DEF 7.2 Y+0", "CYCL DEF 7.3 Z+0", "CYCL DEF 10.0 ROTATION", "CYCL DEF 10.1 ROT+0",
        "CYCL DEF 26.0 AXIS-SPEC. SCALING", "CYCL DEF 26.1 X1 CCX+0 CCY+0"})
    add(block);
  for (std::size_t r = 0; r < 2; ++r) {
    const auto& at = p.rings[r].at_m;
    add(fmt::format(
        "TCH PROBE 421 MEASURE HOLE ~\n    Q273={:+.4f} ~\n    Q274={:+.4f} ~\n    Q262={:+.3f} ~\n    Q325=+0 ~\n"
        "    Q247=+90 ~\n    Q261={:+.4f} ~\n    Q320=+2 ~\n    Q260={:+.4f} ~\n    Q301=+0 ~\n"
        "    Q275={:+.3f} ~\n    Q276={:+.3f} ~\n    Q279=+3 ~\n    Q280=+3 ~\n    Q281=+0 ~\n    Q309=+0 ~\n"
        "    Q330=+0",
        1e3 * at[0], 1e3 * at[1], bore_mm, 1e3 * (at[2] - p.depth_m), 1e3 * (at[2] + p.clearance_m), bore_mm + 1.0,
        bore_mm - 1.0));
    add(fmt::format("FN 11: IF +Q153 GT {:+.3f} GOTO LBL 99", bore_mm + 1.0));
    add(fmt::format("FN 12: IF +Q153 LT {:+.3f} GOTO LBL 99", bore_mm - 1.0));
    add(fmt::format("FN 0: Q{} = +Q151", 1 + 10 * r));
    add(fmt::format("FN 0: Q{} = +Q152", 2 + 10 * r));
  }
  add(fmt::format("Q20 = ( Q11 - Q1 ) / {}", mm(b[0] - a[0])));
  add(fmt::format("FN 11: IF +Q20 GT +{:.6f} GOTO LBL 99", 1.0 + kMostScale));
  add(fmt::format("FN 12: IF +Q20 LT +{:.6f} GOTO LBL 99", 1.0 - kMostScale));
  add(fmt::format("Q40 = Q1 - Q20 * ( {} )", mm(a[0])));  // the datum shift acts after the scale
  add("FN 0: Q42 = +Q20");
  add(fmt::format("Q43 = ATAN ( ( Q12 - Q2 ) / ( Q11 - Q1 ) ) - ( {:.9f} )",
                  kDegrees * std::atan2(b[1] - a[1], b[0] - a[0])));
  add(fmt::format("Q41 = ( Q2 + Q12 ) / 2 - ( {} ) - SIN Q43 * ( Q1 + Q11 ) / 2", mm(0.5 * (a[1] + b[1]))));
  add(fmt::format("Q46 = {}", mm(0.5 * (a[1] + b[1]))));
  for (const char* block :
       {"FN 0: Q44 = +0", "LBL 99", "CYCL DEF 7.0 DATUM SHIFT", "CYCL DEF 7.1 X+Q40", "CYCL DEF 7.2 Y+Q41",
        "CYCL DEF 10.0 ROTATION", "CYCL DEF 10.1 ROT+Q43", "CYCL DEF 26.0 AXIS-SPEC. SCALING",
        "CYCL DEF 26.1 XQ42 CCX+0 CCY+0", "FN 10: IF +Q45 NE +1 GOTO LBL 97", "CYCL DEF 26.0 AXIS-SPEC. SCALING",
        "CYCL DEF 26.1 XQ42 YQ42 CCX+0 CCYQ46", "LBL 97", "FN 9: IF +Q44 EQU +0 GOTO LBL 100", "FN 14: ERROR = 1000",
        "LBL 100", "END PGM THERMFRAME MM"})
    add(block);
  return {{"heidenhain/THERMFRAME.H", numbered(blocks)}};
}

}  // namespace driftwright::compensation
