#pragma once
// What the corrections of an NC program are made for: `schedule:` of a scenario (docs/reference/scenario.md).

#include <vector>

#include "base/config_map.hpp"
#include "nc/correction.hpp"
#include "nc/program.hpp"
#include "scenarios/reader/read_outputs.hpp"

namespace driftwright::scenarios {

inline const std::vector<std::string> kSchedulePolicies = {"paper", "minimal"};

/// An axis of the program that is corrected.
struct ScheduleAxis {
  int axis = 0;                   ///< 0, 1, 2 = x, y, z of the program
  std::string displacement = {};  ///< channel in um
  double sign = 1.0;              ///< +1: the displacement counts in the axis's direction, -1: against it
  double tolerance_um = 10.0;
};

struct ScheduleSettings {
  std::vector<ScheduleAxis> axes;  ///< x, y, z in this order
  std::string policy = "minimal";
  bool absolute = false;  ///< corrections overwrite the offset: base_offset_m and the correction
  int work_offset = 540;  ///< times ten
  std::array<double, 3> base_offset_m = {0, 0, 0};
  int parts = 1;            ///< that the program makes one after another
  double between_s = 0.0;   ///< at rest between two of them
  bool from_start = false;  ///< the drift counts from the start of the program, not from the reference temperature
  NcSettings nc;
  double resolution_s = 10.0;  ///< of the cyclogram made of the program
  double cutting_power_W = 0.0;
  Where where;
};

/// What the key `schedule` may hold.
[[nodiscard]] schema::Map schedule_schema();
/// @param displacements  of the scenario's machine
/// @param tolerance_um   where an axis has none of its own
/// @throws InputError  file, line and key
[[nodiscard]] ScheduleSettings read_schedule(const ConfigMap& in, const std::vector<DisplacementOutput>& displacements,
                                             double tolerance_um);

}  // namespace driftwright::scenarios
