#include "studies/machine_study.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "compensation/predictors/fitted_formulas.hpp"
#include "compensation/predictors/formula_predictor.hpp"
#include "compensation/sensors/thermometers.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "studies/planner.hpp"
#include "studies/sensor_regressions.hpp"
#include "studies/thermal_modes.hpp"

namespace driftwright::studies {
namespace {

using namespace compensation;
using scenarios::Scenario;

constexpr const char* kByRegression = "regression";  // the predictor that also goes through the axis

std::vector<Record> training_records(const MachineStudy& study) {
  std::vector<Record> records;
  for (const scenarios::SimulatedRun& run : study.train) records.push_back(run.record);
  return records;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

ModalError modal_error(const Record& predicted, const Record& full, const std::vector<std::string>& displacements,
                       int n_modes, bool with_steady_responses) {
  ModalError error{
      .n_modes = n_modes, .with_steady_responses = with_steady_responses, .worst_sensor = {}, .worst_displacement_um = {}};
  for (const std::string& sensor : scenarios::sensor_channels(full)) {
    const double difference_K = largest_difference(predicted.at(sensor).values, full.at(sensor).values);
    if (difference_K >= error.worst_temperature_K) {
      error.worst_temperature_K = difference_K;
      error.worst_sensor = sensor;
    }
  }
  for (const std::string& d : displacements) {
    error.worst_displacement_um.push_back(largest_difference(predicted.at(d).values, full.at(d).values));
  }
  return error;
}

/// The modes used for correction: the completed ones.
ModalPredictor fit_modal(MachineStudy& study, const Scenario& scenario, const scenarios::Model& model) {
  const Cyclogram& judged = scenario.cyclogram(scenario.study->judge);
  const int n_modes = scenario.study->thermal_modes;
  std::vector<Cyclogram> felt;
  for (const scenarios::SimulatedRun& run : study.train) {
    felt.push_back(scenarios::felt_run(*scenario.machine, scenario.cyclogram(run.record.source)).cyclogram);
  }
  std::vector<const Cyclogram*> training;
  for (const Cyclogram& cyclogram : felt) training.push_back(&cyclogram);
  const Drive typical = mean_drive(training);
  const ModalPredictors predictors = scenarios::modal_predictors(scenario, model, n_modes, typical);
  for (bool with_steady_responses : {false, true}) {
    study.modal_prediction =
        foretold_record(*scenario.machine, model.outputs(), with_steady_responses ? predictors.completed : predictors.bare,
                        judged, study.judged.record.time_s);
    study.modal_errors.push_back(
        modal_error(study.modal_prediction, study.judged.record, study.displacements, n_modes, with_steady_responses));
  }
  study.modal_time_constant_s = predictors.completed.time_constant_s;
  return predictors.completed;
}

compensation::DeployedPredictor by_regression(const char* name, const Regression& regression) {
  compensation::DeployedPredictor d;
  d.name = name;
  d.target = regression.target;
  d.sensors = regression.inputs;
  d.predictor = std::make_shared<FormulaPredictor>(as_drift_model(regression));
  return d;
}

/// The largest error of a predictor on runs [um].
double largest_miss_um(const compensation::DeployedPredictor& d, const std::vector<MachineRun>& runs) {
  double largest = 0.0;
  for (const MachineRun& run : runs)
    largest = std::max(largest, largest_difference(live(*d.predictor, run), run.readings.at(d.target).values));
  return largest;
}

void correct(MachineStudy& study, const Scenario& scenario) {
  const scenarios::Study& settings = *scenario.study;
  // The injector uses readings of the run itself. A schedule is written before the run; it may only use the temperatures
  // that the modal model predicts.
  const auto as_observed = [&](const scenarios::SimulatedRun& run) {
    return MachineRun{scenario.cyclogram(run.record.source), scenario.machine->ambient,
                      as_read(run.record, {.resolution_K = settings.sensor_resolution_K}, 0)};
  };
  std::vector<MachineRun> training;
  for (const scenarios::SimulatedRun& run : study.train) training.push_back(as_observed(run));
  const MachineRun judged = as_observed(study.judged);
  const MachineRun foretold{judged.cyclogram, judged.ambient, study.modal_prediction};
  std::vector<double> durations_s;
  for (const auto& section : judged.cyclogram.sections) durations_s.push_back(section.duration_s);
  const std::vector<double> boundaries_s = operation_boundaries_s(durations_s);
  for (const compensation::DeployedPredictor& d : study.predictors) {
    const DriftToCorrect run{judged.readings.time_s, study.judged.record.at(d.target).values, boundaries_s,
                             settings.tolerance_um};
    const double margin_um = largest_miss_um(d, training);
    for (CorrectedDrift corrected : {correct_by_injector(run, live(*d.predictor, judged), settings.encoder_period_um),
                                     correct_by_schedule(run, ahead(*d.predictor, foretold), margin_um, planner_of(scenario),
                                                         scenario.limits.correction)}) {
      corrected.predictor = d.name;
      corrected.channel = d.target;
      study.corrections.push_back(std::move(corrected));
    }
  }
}

void run_axis(MachineStudy& study, const scenarios::AxisLoopSettings& settings, double most_um) {
  const auto d =
      std::find_if(study.predictors.begin(), study.predictors.end(), [&](const compensation::DeployedPredictor& p) {
        return p.name == kByRegression && p.target == settings.displacement;
      });
  study.axis_loop = run_axis_loop(settings.loop, study.judged.record, settings.displacement, [&](const Record& readings) {
    std::vector<double> correction_um = live(*d->predictor, {.cyclogram = {}, .ambient = {}, .readings = readings});
    for (double& c_um : correction_um) c_um = std::isnan(c_um) ? c_um : std::clamp(c_um, -most_um, most_um);
    return correction_um;
  });
}

void find_ambiguities(MachineStudy& study, const Scenario& scenario) {
  std::vector<Record> records = training_records(study);
  records.push_back(study.judged.record);
  for (const scenarios::Sensor& sensor : scenario.machine->sensors) {
    if (!std::holds_alternative<scenarios::PointOnRegion>(sensor.place))
      continue;  // a thermometer in the air shows nothing of the machine
    const auto ambiguity = temperature_ambiguity(records, sensor.name, scenario.study->target);
    if (ambiguity) study.ambiguities.push_back({sensor.name, *ambiguity});
  }
  std::stable_sort(
      study.ambiguities.begin(), study.ambiguities.end(),
      [](const SensorAmbiguity& a, const SensorAmbiguity& b) { return a.ambiguity.spread > b.ambiguity.spread; });
}

}  // namespace

std::vector<const CorrectedDrift*> MachineStudy::of_channel(const std::string& channel) const {
  std::vector<const CorrectedDrift*> found;
  for (const CorrectedDrift& c : corrections) {
    if (c.channel == channel) found.push_back(&c);
  }
  return found;
}

MachineStudy study_machine(const Scenario& scenario, const scenarios::Model& model, const Listener& listener,
                           const scenarios::FieldSink& fields) {
  MachineStudy study;
  const scenarios::Study& settings = *scenario.study;
  std::vector<const Cyclogram*> cyclograms;
  for (const std::string& name : settings.train) cyclograms.push_back(&scenario.cyclogram(name));
  cyclograms.push_back(&scenario.cyclogram(settings.judge));
  study.train = scenarios::simulate_cyclograms(scenario, model, cyclograms, listener,
                                               {.cyclogram = cyclograms.size() - 1, .take = fields.take});
  for (const scenarios::SimulatedRun& run : study.train)
    study.worst_energy_gap = std::max(study.worst_energy_gap, run.trajectory.energy_gap());
  study.judged = std::move(study.train.back());
  study.train.pop_back();
  for (const auto& d : scenario.machine->displacements) study.displacements.push_back(d.name);
  listener.begin("fitting and correcting");
  SensorRegressions fitted = fit_on_best_sensors(training_records(study), settings, study.displacements);
  study.ranking = std::move(fitted.ranking);
  study.regressions = std::move(fitted.regressions);
  study.single_sensor = std::move(fitted.single_sensor);
  const ModalPredictor modes = fit_modal(study, scenario, model);
  for (std::size_t d = 0; d < study.displacements.size(); ++d) {
    study.predictors.push_back(by_regression("one thermometer", study.single_sensor[d]));
    study.predictors.push_back(by_regression(kByRegression, study.regressions[d]));
    study.predictors.push_back(by_thermal_modes(*scenario.machine, model.outputs(), modes, study.displacements[d]));
  }
  correct(study, scenario);
  if (scenario.axis_loop) run_axis(study, *scenario.axis_loop, scenario.limits.correction.most_um);
  find_ambiguities(study, scenario);
  return study;
}

}  // namespace driftwright::studies
