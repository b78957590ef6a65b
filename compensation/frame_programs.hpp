#pragma once
// The thermal frame of a table as programs of controls: probing of the rings, the frame made of them, the temperature data.
//
// Each program carries the rings' places at the reference temperature and makes scale and shift on the control itself; the numbers
// of the last measurement stand in it as comments or as the values in force.

#include <string>
#include <vector>

#include "compensation/axis_temperature.hpp"

namespace driftwright::compensation {

/// A ring at the reference temperature.
struct ProgramRing {
  std::string name = {};
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  ///< middle of its upper edge, machine coordinates
};

struct FrameProgram {
  std::vector<ProgramRing> rings = {};  ///< exactly two, by rising x
  TableFrame frame = {};                ///< of the last measurement
  AxisTemperature control = {};
  double temperature_K = 293.15;  ///< that the data in force are for
  double free_diameter_m = 0.044;
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

/// THERMFRAME.SPF: measures both rings by four touches each, makes TEMP_SCALE and TEMP_SHIFT and writes $P_BFRAME; refuses what
/// temp_frame() refuses. THERMDATA.SPF: SD43900, SD43910, SD43920 with MD32750 and MD32760.
[[nodiscard]] std::vector<ProgramFile> siemens_frame(const FrameProgram& program);

/// thermframe.ngc: G38.2 touches, then G10 L2 P1 with X (TEMP_SHIFT), Y, Z and R (turn); joint_0.comp: the scale, which LinuxCNC
/// reads at its start (COMP_FILE_TYPE = 1).
[[nodiscard]] std::vector<ProgramFile> linuxcnc_frame(const FrameProgram& program);

/// THERMFRAME.H: TCH PROBE 421 at both rings, then CYCL DEF 7 (datum shift), 10 (rotation) and 26 (scale of X).
[[nodiscard]] std::vector<ProgramFile> heidenhain_frame(const FrameProgram& program);

/// All of them. @throws std::logic_error  for other than two rings
[[nodiscard]] std::vector<ProgramFile> frame_programs(const FrameProgram& program);

}  // namespace driftwright::compensation
