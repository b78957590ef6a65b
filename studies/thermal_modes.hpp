#pragma once
// Predictions of a cyclogram by the thermal modes of a scenario's model: its record, and its drift as a predictor.

#include "compensation/predictors/deployed_predictor.hpp"
#include "machine/model.hpp"

namespace driftwright::studies {

/// The record of a cyclogram as predicted by the modes: sensors in degC, displacements in um, tilts in urad, as
/// instruments would read them.
/// @param outputs    of the model that the modes belong to
/// @param cyclogram  as recorded; the machine's effects give the real drive
/// @param time_s     strictly increasing, from 0
[[nodiscard]] Record foretold_record(const scenarios::MachineModel& machine, const solver::Outputs& outputs,
                                     const compensation::ModalPredictor& modes, const Cyclogram& cyclogram,
                                     const std::vector<double>& time_s);

/// A predictor of one displacement of those records, with its recorded value and not its change since the start, in any
/// ambient.
/// @param target  displacement of the machine, in um
[[nodiscard]] compensation::DeployedPredictor by_thermal_modes(const scenarios::MachineModel& machine,
                                                               const solver::Outputs& outputs,
                                                               const compensation::ModalPredictor& modes,
                                                               const std::string& target);

}  // namespace driftwright::studies
