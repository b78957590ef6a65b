#pragma once
// How each control's language writes what corrections need: an offset of its axes, a straight line to a point, a remark.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "nc/dialect.hpp"
#include "nc/step.hpp"

namespace driftwright {

struct NcOffsetOptions {
  NcDialect dialect = NcDialect::kLinuxCnc;
  bool shares_g92 = false;  ///< LinuxCNC: the program has a G92 or G52 of its own
  bool absolute = false;    ///< the offset is base_m and the correction: whatever stood there is lost
  int work_offset = 540;    ///< LinuxCNC, absolute: 540 ... 590, 591, 592, 593 for G54 ... G59.3
  std::array<double, 3> base_m = {0, 0,
                                  0};  ///< absolute: what the offset (base frame, datum shift) holds without corrections
  std::array<bool, 3> axes = {false, false, false};  ///< that corrections are written for
};

/// What an offset written to 1e-6 mm or 1e-7 inch really is.
[[nodiscard]] double as_written_m(double x_m, double unit_m);

/// Lines that bring the corrections of `axes` from one value to another, on top of what the operator has set:
///
///   LinuxCNC         G52 X-0.0125                                  its own shift above G54 ... G59.3, which it leaves alone
///                    G92 X[#5420+0.0025]                           the same by the difference, where the program has one of its own
///   Siemens          $P_BFRAME[X,TR]=$P_UBFR[X,TR]-0.0125          the base frame in force from the one that the operator has set
///   Siemens, G291    G290, the same, G291
///   Heidenhain       G54 G91 X-0.0025, G90; CYCL DEF 7.0, CYCL DEF 7.1 IX-0.0025      the datum shift, by the difference
///
/// Absolute: G10 L2 P1 X0.0125; $P_BFRAME[X,TR]=0.0125; G54 X+0.0125; CYCL DEF 7.1 X+0.0125.
/// @param from_m, to_m  corrections of the offset; both as_written_m()
/// @param before        modes in force
/// Sources: LinuxCNC documentation, "G-Codes" (G10 L2, G52) and "Coordinate Systems"; Siemens, SINUMERIK 840D sl, Function Manual Basic
/// Functions, K2: frames in data management ($P_UBFR) and in force ($P_BFRAME), which G54 or a reset loads anew; Heidenhain, TNC 640 User's Manual
/// Cycle Programming, cycle 7: an incremental shift counts from the datum in force.
[[nodiscard]] std::vector<std::string> offset_lines(const NcOffsetOptions& options, const std::array<bool, 3>& axes,
                                                    const std::array<double, 3>& from_m, const std::array<double, 3>& to_m,
                                                    const NcModes& before);

/// LinuxCNC, additive: refuses to run where another G92 or G52 is in force, or, for x and y, a rotated work offset.
[[nodiscard]] std::vector<std::string> guard_lines(const NcOffsetOptions& options);

/// A straight line, absolute whatever is in force, with `feed` (such as "F200") or none. @param to_m  the axes it names
[[nodiscard]] std::vector<std::string> straight_lines(NcDialect dialect, bool rapid,
                                                      const std::array<std::optional<double>, 3>& to_m,
                                                      const std::string& feed, const NcModes& before);

[[nodiscard]] std::string remark_line(NcDialect dialect, const std::string& text);

}  // namespace driftwright
