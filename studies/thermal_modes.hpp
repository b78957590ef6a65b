#pragma once
// What the thermal modes of a scenario's model tell of a cyclogram before it is run: its record, and its drift as a predictor.

#include "compensation/predictors/deployed_predictor.hpp"
#include "machine/model.hpp"

namespace driftwright::studies {

/// The record of a cyclogram as the modes foretell it: sensors in degC, displacements in um, tilts in urad, as instruments would tell them.
/// @param outputs    of the model that the modes are of
/// @param cyclogram  as recorded; the machine's effects say what is felt
/// @param time_s     strictly increasing, from 0
[[nodiscard]] Record foretold_record(const scenarios::MachineModel& machine, const solver::Outputs& outputs,
                                     const compensation::ModalPredictor& modes, const Cyclogram& cyclogram,
                                     const std::vector<double>& time_s);

/// One displacement of those records, as recorded and not from the start, in whatever ambient a run has.
/// @param target  displacement of the machine, in um
[[nodiscard]] compensation::DeployedPredictor by_thermal_modes(const scenarios::MachineModel& machine,
                                                               const solver::Outputs& outputs,
                                                               const compensation::ModalPredictor& modes,
                                                               const std::string& target);

}  // namespace driftwright::studies
