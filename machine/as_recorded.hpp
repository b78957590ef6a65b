#pragma once
// From a run of the machine to its record: what instruments make of it.

#include "base/record.hpp"
#include "scenarios/reader/scenario.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::scenarios {

/// The record of a run: drive as recorded; sensors, displacements and tilts as instruments tell them. A sensor on the ambient reads
/// the recorded ambient; where there is none, the channel `ambient` does.
/// @param run  of felt_run(model, recorded)
[[nodiscard]] Record as_recorded(const MachineModel& model, const solver::Trajectory& run, const solver::Outputs& outputs,
                                 const Cyclogram& recorded);

}  // namespace driftwright::scenarios
