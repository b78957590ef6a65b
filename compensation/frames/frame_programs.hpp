#pragma once
// The thermal frame of a table as programs for controls: probing of the rings, the frame computed from them, the temperature
// data.
//
// Each program contains the rings' positions at the reference temperature and computes scale and shift on the control
// itself. The numbers of the last measurement are in it as comments or as the values in force.

#include <limits>
#include <string>
#include <vector>

#include "compensation/frames/axis_temperature.hpp"

namespace driftwright::compensation {

/// A ring at the reference temperature.
struct ProgramRing {
  std::string name = {};
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  ///< centre of its upper edge, where the probe's tip touches it
};

/// Data of the programs. All positions are in machine coordinates without the probe's length; in_machine() converts them.
struct FrameProgram {
  std::vector<ProgramRing> rings = {};  ///< exactly two, in order of x, on a line along x
  TableFrame frame = {};                ///< of the last measurement
  AxisTemperature control = {};
  bool against_dk = false;                             ///< the control moves the axis by -dK; else by +dK
  double temperature_K = 293.15;                       ///< the temperature that the data in force apply to
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< of the mesh, in machine coordinates
  double free_diameter_m = 0.044;                      ///< diameter of the ring less that of the stylus ball
  double ball_diameter_m = 6e-3;
  int probe_tool = 99;                ///< number of the probe in the tool table of LinuxCNC; above 0
  double feed_mm_min = 300.0;         ///< feed of touches
  double depth_m = 5e-3;              ///< depth of the stylus in the ring
  double clearance_m = 50e-3;         ///< height above the ring while moving to it
  double velocity_m_s = 0.5;          ///< MD32000
  double slew = 0.01;                 ///< MD32760
  double low_m = -5.0, high_m = 5.0;  ///< of the compensation table along X
  double most_correction_um = std::numeric_limits<double>::infinity();  ///< limit of the scenario, for a comment
  std::string made_by = {};
};

/// A file for a control.
struct ProgramFile {
  std::string name = {}, text = {};
};

/// Largest plausible change of a ring's height [m]; more means a wrong probe length or origin, not a temperature change.
inline constexpr double kMostRise_m = 1e-3;
/// Largest deviation of rings from the line along X, as a share of their distance: a turn of 100 urad then changes
/// TEMP_SCALE by 1e-7.
inline constexpr double kMostOffLine = 1e-3;

/// Converts a program whose positions refer to the mesh's origin to machine coordinates, including its frame.
/// @param origin_m  the mesh's origin in the machine's coordinates
/// @throws InputError  as frame_programs()
[[nodiscard]] FrameProgram in_machine(FrameProgram program, const Eigen::Vector3d& origin_m);

/// THERMFRAME.SPF: measures both rings by four touches each (RINGMEAS.SPF), computes TEMP_SCALE and TEMP_SHIFT and writes
/// $P_UBFR and $P_BFRAME; it refuses what temp_frame() refuses and then keeps the old frame; the alarm comes after the way
/// back. The way down to a ring is a touch, too. THERMDATA.SPF: SD43900,
/// SD43910, SD43920 with MD32750 and MD32760.
[[nodiscard]] std::vector<ProgramFile> siemens_frame(const FrameProgram& program);

/// thermframe.ngc: G38.3 touches in G59.2, then G10 L2 P9 (G59.3) with the user's G54 plus X (TEMP_SHIFT), Y, Z and R
/// (turn); joint_0.comp: the scale, which LinuxCNC reads when it starts (COMP_FILE_TYPE = 1).
[[nodiscard]] std::vector<ProgramFile> linuxcnc_frame(const FrameProgram& program);

/// THERMFRAME.H: TCH PROBE 421 at both rings, then CYCL DEF 7 (datum shift), 10 (rotation) and 26 (scale of X).
[[nodiscard]] std::vector<ProgramFile> heidenhain_frame(const FrameProgram& program);

/// The reason why no program can be made for these rings; "" if one can.
[[nodiscard]] std::string why_no_program(const std::vector<ProgramRing>& rings);

/// The programs for all three controls. @throws InputError  with why_no_program()
[[nodiscard]] std::vector<ProgramFile> frame_programs(const FrameProgram& program);

}  // namespace driftwright::compensation
