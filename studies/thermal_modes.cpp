#include "studies/thermal_modes.hpp"

#include "compensation/predictors/driven_predictor.hpp"
#include "machine/as_recorded.hpp"
#include "scenarios/reader/felt_run.hpp"

namespace driftwright::studies {

using namespace compensation;

Record foretold_record(const scenarios::MachineModel& machine, const solver::Outputs& outputs, const ModalPredictor& modes,
                       const Cyclogram& cyclogram, const std::vector<double>& time_s) {
  const MachineRun felt = scenarios::felt_run(machine, cyclogram);
  return scenarios::as_recorded(machine, modes.predict(felt.cyclogram, felt.ambient, time_s), outputs, cyclogram);
}

compensation::DeployedPredictor by_thermal_modes(const scenarios::MachineModel& machine, const solver::Outputs& outputs,
                                                 const ModalPredictor& modes, const std::string& target) {
  compensation::DeployedPredictor d;
  d.name = "thermal modes";
  d.target = target;
  d.predictor = std::make_shared<DrivenPredictor>([machine, outputs, modes, target](const Cyclogram& cyclogram,
                                                                                    const TimeSeries& ambient,
                                                                                    const std::vector<double>& time_s) {
    scenarios::MachineModel there = machine;
    there.ambient = ambient;
    return foretold_record(there, outputs, modes, cyclogram, time_s).at(target).values;
  });
  return d;
}

}  // namespace driftwright::studies
