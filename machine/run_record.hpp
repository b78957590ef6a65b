#pragma once
// Runs of a machine as records.

#include <vector>

#include "base/cyclogram.hpp"
#include "base/record.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::scenarios {

/// A trajectory as a record: speed_rpm, feeds in mm/min and cutting power in W where the cyclogram uses them, sensors in
/// degC, displacements in um, tilts in urad; no mean temperatures of bodies.
[[nodiscard]] Record to_record(const solver::Trajectory& run, const solver::Outputs& outputs, const Cyclogram& cyclogram,
                               double reference_K);

/// 0, interval, 2 interval, ..., further times within the cyclogram, and its end [s].
[[nodiscard]] std::vector<double> output_times_s(const Cyclogram& cyclogram, double interval_s,
                                                 const std::vector<double>& further_s = {});

}  // namespace driftwright::scenarios
