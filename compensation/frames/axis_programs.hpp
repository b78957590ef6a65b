#pragma once
// The touch cycle of one axis as programs for controls: a probe touches a fixed gauge, and what it finds is added to an
// offset of the axis, within limits.
//
// The tip reads r on the axis, in machine coordinates and without the offset, and the gauge is at g at the reference: the
// axis is off by g - r, and the offset that corrects it is r - g. A touch changes the offset that is in force only after
// all checks, in the last block. So a program that is aborted, or that refuses a touch, leaves the last good one.

#include <string>
#include <vector>

#include "compensation/frames/frame_programs.hpp"

namespace driftwright::compensation {

/// Data of the programs. The gauge is a face across the axis.
struct AxisProgram {
  int axis = 2;                                    ///< 0, 1, 2: x, y, z
  double toward = -1.0;                            ///< direction of the touch along the axis: 1 or -1; z is touched downward
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  ///< tip of the probe as it touches, machine coordinates at the reference
  double feed_mm_min = 300.0;                      ///< of the first touch; the one that counts has kSlowTouch of it
  double clearance_m = 50e-3;                      ///< height above `at_m` while moving to it
  int probe_tool = 1;                              ///< number of the probe in the tool table of LinuxCNC; above 0
  double first_um = 0.0;  ///< largest offset that the first touch may find, where none is in force; above 0
  double step_um = 0.0;   ///< largest change of an offset in force; above 0
  double most_um = 0.0;   ///< largest offset by size; above 0
  /// LinuxCNC: the value goes to the component of a model (models/NAME_axis.comp, names=thermal), which has its own filter
  /// and limits, and not into an offset of the program's own.
  bool to_component = false;
  std::string made_by = {};
};

/// The letter of the axis, such as 'Z'.
[[nodiscard]] inline char letter_of(const AxisProgram& program) {
  return "XYZ"[program.axis];
}

/// The same in small, such as 'z'.
[[nodiscard]] inline char small_letter_of(const AxisProgram& program) {
  return "xyz"[program.axis];
}

/// probe_z.ngc: the subprogram o<probe_z>, which touches by G38.3 in G59.2, keeps the offset in G59.1 and writes
/// G59.3, the user's G54 with the offsets of G59.1. The way down to the gauge is a G38.3, too: what is touched there
/// stops it. A touch reads the place of the joint, external offsets included
/// (measured on LinuxCNC 2.9); these are subtracted.
[[nodiscard]] std::vector<ProgramFile> linuxcnc_axis(const AxisProgram& program);

/// PROBEZ.SPF and TOUCHZ.SPF: MEAS=1 without frames, also on the way down; an alarm comes after the way back, because it
/// may end the program; the offset is the fine part of the base frame, $P_UBFR[axis,FI].
[[nodiscard]] std::vector<ProgramFile> siemens_axis(const AxisProgram& program);

/// PROBEZ.H: TCH PROBE 427, which the datum shift in force is added to; the change is added to it by cycle 7, and Q48
/// (Q47 of y, Q46 of x) has the offset in force.
[[nodiscard]] std::vector<ProgramFile> heidenhain_axis(const AxisProgram& program);

/// The programs for all three controls. @throws InputError  for a touch of z upward
[[nodiscard]] std::vector<ProgramFile> axis_programs(const AxisProgram& program);

}  // namespace driftwright::compensation
