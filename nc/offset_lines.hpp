#pragma once
// The lines that corrections need, in each control's language: an offset of its axes, a straight line to a point, a comment.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "nc/dialect.hpp"
#include "nc/step.hpp"

namespace driftwright {

/// How corrections are written.
struct NcOffsetOptions {
  NcDialect dialect = NcDialect::kLinuxCnc;
  bool shares_g92 = false;                   ///< LinuxCNC: the program itself uses G92 or G52
  bool absolute = false;                     ///< the offset is set to base_m plus the correction; its previous value is lost
  int work_offset = 540;                     ///< LinuxCNC, absolute: 540 ... 590, 591, 592, 593 for G54 ... G59.3
  std::array<double, 3> base_m = {0, 0, 0};  ///< absolute: the offset (base frame, datum shift) without corrections
  std::array<bool, 3> axes = {false, false, false};  ///< the axes that are corrected
  std::vector<std::string> remarks = {};             ///< for the program's user, after the first comment
};

/// The value of an offset after rounding to 1e-6 mm or 1e-7 inch, as it is written.
[[nodiscard]] double as_written_m(double x_m, double unit_m);

/// Lines that change the corrections of `axes` from one value to another, in addition to what the operator has set:
///
///   LinuxCNC G52 X-0.0125 a separate shift added to G54 ... G59.3, which are not changed
///                    G92 X[#5420+0.0025] the same by the difference, if the program itself uses G92 or G52
///   Siemens $P_BFRAME[X,TR]=$P_UBFR[X,TR]-0.0125 the active base frame, from the one that the operator has set Siemens,
///   G291 G290, the same, G291 Heidenhain G54 G91 X-0.0025, G90; CYCL DEF 7.0, CYCL DEF 7.1 IX-0.0025 the datum shift, by
///   the difference
///
/// Absolute: G10 L2 P1 X0.0125; $P_BFRAME[X,TR]=0.0125; G54 X+0.0125; CYCL DEF 7.1 X+0.0125.
/// @param from_m, to_m  corrections of the offset; both as_written_m()
/// @param before        modes in force
/// Sources: LinuxCNC documentation, "G-Codes" (G10 L2, G52) and "Coordinate Systems"; Siemens, SINUMERIK 840D sl, Function
/// Manual Basic Functions, K2: frames in data management ($P_UBFR) and in force ($P_BFRAME), which G54 or a reset loads
/// anew; Heidenhain, TNC 640 User's Manual Cycle Programming, cycle 7: an incremental shift counts from the datum in force.
[[nodiscard]] std::vector<std::string> offset_lines(const NcOffsetOptions& options, const std::array<bool, 3>& axes,
                                                    const std::array<double, 3>& from_m, const std::array<double, 3>& to_m,
                                                    const NcModes& before);

/// LinuxCNC, additive: lines that stop the program if another G92 or G52 is in force or, for x and y, a rotated work offset.
[[nodiscard]] std::vector<std::string> guard_lines(const NcOffsetOptions& options);

/// A straight line to an absolute position in any mode, with `feed` (such as "F200") or none. @param to_m  the axes to name
[[nodiscard]] std::vector<std::string> straight_lines(NcDialect dialect, bool rapid,
                                                      const std::array<std::optional<double>, 3>& to_m,
                                                      const std::string& feed, const NcModes& before);

/// A comment.
[[nodiscard]] std::string remark_line(NcDialect dialect, const std::string& text);

}  // namespace driftwright
