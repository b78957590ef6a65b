#pragma once
// The thermal frame of a table as programs of controls: probing of the rings, the frame made of them, the temperature data.
//
// Each program carries the rings' places at the reference temperature and makes scale and shift on the control itself; the numbers
// of the last measurement stand in it as comments or as the values in force.

#include <string>
#include <vector>

#include "compensation/frames/axis_temperature.hpp"

namespace driftwright::compensation {

/// A ring at the reference temperature.
struct ProgramRing {
  std::string name = {};
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  ///< middle of its upper edge, where the probe's tip meets it
};

/// All places are in the machine's coordinates with the probe's length taken off; in_machine() brings them there.
struct FrameProgram {
  std::vector<ProgramRing> rings = {};  ///< exactly two, by rising x, on a line along x
  TableFrame frame = {};                ///< of the last measurement
  AxisTemperature control = {};
  bool against_dk = false;                             ///< the control moves the axis by -dK; else by +dK
  double temperature_K = 293.15;                       ///< that the data in force are for
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< of the mesh, in the machine's coordinates
  double free_diameter_m = 0.044;                      ///< ring less stylus ball
  double ball_diameter_m = 6e-3;
  double feed_mm_min = 300.0;         ///< of touches
  double depth_m = 5e-3;              ///< of the stylus in the ring
  double clearance_m = 50e-3;         ///< above it on the way
  double velocity_m_s = 0.5;          ///< MD32000
  double slew = 0.01;                 ///< MD32760
  double low_m = -5.0, high_m = 5.0;  ///< of the compensation table along X
  std::string made_by = {};
};

/// A file for a control.
struct ProgramFile {
  std::string name = {}, text = {};
};

/// A ring higher or lower than it was by more than this is a wrong probe length or origin and no temperature [m].
inline constexpr double kMostRise_m = 1e-3;
/// Rings may leave the line along X by this share of their distance: a turn of 100 urad then changes TEMP_SCALE by 1e-7.
inline constexpr double kMostOffLine = 1e-3;

/// A program whose places count from the mesh's origin, moved to the machine's coordinates; the same frame, seen from there.
/// @param origin_m  the mesh's origin in the machine's coordinates
/// @throws InputError  as frame_programs()
[[nodiscard]] FrameProgram in_machine(FrameProgram program, const Eigen::Vector3d& origin_m);

/// THERMFRAME.SPF: measures both rings by four touches each (RINGMEAS.SPF), makes TEMP_SCALE and TEMP_SHIFT and writes $P_UBFR and
/// $P_BFRAME; refuses what temp_frame() refuses and leaves the old frame then. THERMDATA.SPF: SD43900, SD43910, SD43920 with MD32750
/// and MD32760.
[[nodiscard]] std::vector<ProgramFile> siemens_frame(const FrameProgram& program);

/// thermframe.ngc: G38.3 touches in G59.2, then G10 L2 P9 (G59.3) with the user's G54 and X (TEMP_SHIFT), Y, Z and R (turn) on it;
/// joint_0.comp: the scale, which LinuxCNC reads at its start (COMP_FILE_TYPE = 1).
[[nodiscard]] std::vector<ProgramFile> linuxcnc_frame(const FrameProgram& program);

/// THERMFRAME.H: TCH PROBE 421 at both rings, then CYCL DEF 7 (datum shift), 10 (rotation) and 26 (scale of X).
[[nodiscard]] std::vector<ProgramFile> heidenhain_frame(const FrameProgram& program);

/// Why no program can be made for these rings; "" if one can.
[[nodiscard]] std::string why_no_program(const std::vector<ProgramRing>& rings);

/// All of them. @throws InputError  with why_no_program()
[[nodiscard]] std::vector<ProgramFile> frame_programs(const FrameProgram& program);

}  // namespace driftwright::compensation
