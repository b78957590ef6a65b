#pragma once
// Converts a run of the machine into its record, with all errors of its instruments.

#include "base/record.hpp"
#include "scenarios/reader/scenario.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::scenarios {

/// The record of a run: drive as recorded; sensors, displacements and tilts as instruments read them. A sensor on the
/// ambient reads the recorded ambient; without such a sensor, the channel `ambient` contains it.
/// @param run  a run of felt_run(model, recorded)
[[nodiscard]] Record as_recorded(const MachineModel& model, const solver::Trajectory& run, const solver::Outputs& outputs,
                                 const Cyclogram& recorded);

}  // namespace driftwright::scenarios
