#pragma once
// The key `schedule` of a scenario: settings of the corrections of an NC program (docs/reference/scenario.md).

#include <vector>

#include "base/config_map.hpp"
#include "nc/correction.hpp"
#include "nc/program.hpp"
#include "scenarios/reader/read_outputs.hpp"

namespace driftwright::scenarios {

inline const std::vector<std::string> kSchedulePolicies = {"paper", "minimal"};

/// A corrected axis of the program.
struct ScheduleAxis {
  int axis = 0;                   ///< 0, 1, 2 = x, y, z of the program
  std::string displacement = {};  ///< channel in um
  double sign = 1.0;              ///< +1: a positive displacement points along the axis, -1: against it
  double tolerance_um = 10.0;
};

struct ScheduleSettings {
  std::vector<ScheduleAxis> axes;  ///< x, y, z in this order
  std::string policy = "minimal";
  bool absolute = false;  ///< corrections replace the offset by base_offset_m plus the correction
  int work_offset = 540;  ///< number of the work offset, times ten
  std::array<double, 3> base_offset_m = {0, 0, 0};
  int parts = 1;            ///< parts that the program makes one after another
  double between_s = 0.0;   ///< pause between two of them
  bool from_start = false;  ///< the drift is zero at the program's start, not at the reference temperature
  NcSettings nc;
  double resolution_s = 10.0;  ///< of the cyclogram made from the program
  double cutting_power_W = 0.0;
  Where where;
};

/// The schema of the key `schedule`.
[[nodiscard]] schema::Map schedule_schema();
/// @param displacements  of the scenario's machine
/// @param tolerance_um   for axes without their own
/// @throws InputError  file, line and key
[[nodiscard]] ScheduleSettings read_schedule(const ConfigMap& in, const std::vector<DisplacementOutput>& displacements,
                                             double tolerance_um);

}  // namespace driftwright::scenarios
