#pragma once
// Canned drilling cycles of NC programs.

#include <array>
#include <optional>

#include "nc/motion.hpp"

namespace driftwright {

/// One block of a canned cycle, in absolute positions [m].
struct NcDrilling {
  int code = 81;                             ///< 73, 81, 82, 83, 84 or 85
  int normal = 2;                            ///< axis of drilling: 2 with G17, 1 with G18, 0 with G19
  std::array<double, 2> first_m = {0, 0};    ///< first hole, in plane_axes(normal)
  std::array<double, 2> spacing_m = {0, 0};  ///< from hole to hole
  int n_holes = 1;                           ///< word L
  double retract_m = 0.0;                    ///< the R level, from which it drills
  double bottom_m = 0.0;                     ///< <= retract_m
  double clear_m = 0.0;                      ///< level at the end of each hole, >= retract_m
  double peck_m = 0.0;                       ///< word Q, > 0 for 73 and 83
  double dwell_s = 0.0;                      ///< at the bottom
};

/// Executes the cycle. Before the first hole a rapid up to the R level if the axis is below it; for each hole a
/// rapid across, a rapid to the R level, then
///   81  feed to the bottom, rapid to clear           82  the same with a dwell at the bottom
///   83  pecks of Q: feed, rapid to R, rapid back to 0.254 mm above the depth reached; at the bottom rapid to clear
///   73  pecks of Q: feed, rapid up by 0.254 mm; at the bottom rapid to clear
///   84  feed to the bottom, dwell, feed to clear; the spindle turns back at the same speed
///   85  feed to the bottom, feed to R, rapid to clear
/// @throws InputError  at motion.where: as NcMotion, for a bottom above R, for more than 1e5 pecks, with G93
/// Source: LinuxCNC documentation, "G-Codes", canned cycles.
void drill(NcMotion& motion, const NcDrilling& cycle);

}  // namespace driftwright
