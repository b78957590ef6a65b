#include "app/prediction.hpp"

#include "compensation/modal_predictor.hpp"
#include "scenarios/as_recorded.hpp"
#include "scenarios/ways_out.hpp"

namespace driftwright::app {

Prediction predict_drift(const scenarios::Scenario& scenario, const Cyclogram& cyclogram, Progress& progress,
                         const std::string& verb) {
  const scenarios::MachineModel& model = require_machine(scenario, verb);
  const Model machine = open_model(scenario, {&cyclogram}, progress, false);
  if (const scenarios::Machine* full = machine.full()) {
    scenarios::require_ways_out(full->placed.mesh, full->placed.balance, model.where);
  }
  progress.begin("computing thermal modes");
  const scenarios::FeltRun felt = scenarios::felt_run(model, cyclogram);
  const int most_modes = scenario.study ? scenario.study->thermal_modes : scenarios::Study{}.thermal_modes;
  const compensation::ModalPredictor predictor =
      modal_predictors(scenario, machine, most_modes, mean_drive({&felt.cyclogram})).completed;
  const std::vector<double> times_s = scenarios::output_times_s(cyclogram, scenario.solver.output_interval_s);
  return {scenarios::as_recorded(model, predictor.predict(felt.cyclogram, felt.hall, times_s), machine.outputs(), cyclogram),
          predictor.time_constant_s.size(),  // a machine of few nodes has fewer than wanted
          machine.is_linear()};
}

std::string prediction_note(const Prediction& prediction) {
  if (prediction.is_linear) return "";
  return "  radiation, films, friction and properties that change with temperature stay as they are in the steady state of "
         "the mean drive; `simulate` follows them\n";
}

}  // namespace driftwright::app
