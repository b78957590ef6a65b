#pragma once
// The study behind `run`: simulates the training cyclograms and the judged one, fits predictors on the former and
// corrects the latter.

#include <optional>

#include "compensation/injector/axis_loop.hpp"
#include "compensation/judging/correction.hpp"
#include "compensation/judging/temperature_ambiguity.hpp"
#include "compensation/predictors/deployed_predictor.hpp"
#include "compensation/predictors/modal_predictor.hpp"
#include "compensation/predictors/regression.hpp"
#include "compensation/sensors/grey_relational.hpp"
#include "machine/simulated_run.hpp"

namespace driftwright::studies {

/// The difference between a modal model and the full model in one run.
struct ModalError {
  int n_modes = 0;
  bool with_steady_responses = false;
  std::string worst_sensor;
  double worst_temperature_K = 0.0;
  std::vector<double> worst_displacement_um;  ///< per displacement channel
};

struct SensorAmbiguity {
  std::string sensor;
  compensation::TemperatureAmbiguity ambiguity;
};

struct MachineStudy {
  std::vector<scenarios::SimulatedRun> train;
  scenarios::SimulatedRun judged;
  std::vector<std::string> displacements;               ///< channels in um
  compensation::Ranking ranking;                        ///< of the thermometers against the target
  std::vector<compensation::Regression> regressions;    ///< on the best sensors, one per displacement
  std::vector<compensation::Regression> single_sensor;  ///< on the best one only: what temperature alone achieves
  std::vector<double> modal_time_constant_s;
  Record modal_prediction;               ///< of the judged cyclogram
  std::vector<ModalError> modal_errors;  ///< on the judged cyclogram: first bare modes, then completed ones
  /// For each displacement: one thermometer, regression, thermal modes.
  std::vector<compensation::DeployedPredictor> predictors;
  /// In the order of the predictors, each first through the pulse injector, then the schedule.
  std::vector<compensation::CorrectedDrift> corrections;
  std::optional<compensation::AxisLoopResult>
      axis_loop;                             ///< the regression through the injector, if the scenario has an `axis_loop`
  std::vector<SensorAmbiguity> ambiguities;  ///< of the target at each point on the machine, worst first
  double worst_energy_gap = 0.0;

  /// The corrections of one channel.
  [[nodiscard]] std::vector<const compensation::CorrectedDrift*> of_channel(const std::string& channel) const;
};

[[nodiscard]] MachineStudy study_machine(const scenarios::Scenario& scenario, const scenarios::Model& model,
                                         const Listener& listener, const scenarios::FieldSink& fields);

}  // namespace driftwright::studies
