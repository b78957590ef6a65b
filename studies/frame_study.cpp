#include "studies/frame_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "compensation/predictors/observability.hpp"
#include "compensation/predictors/regression.hpp"
#include "compensation/sensors/sensor_selection.hpp"
#include "compensation/sensors/thermometers.hpp"
#include "machine/as_recorded.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/reduced_transient.hpp"
#include "studies/linear_physics.hpp"
#include "studies/table_strategy.hpp"
#include "studies/validation_study.hpp"

namespace driftwright::studies {
namespace {

using namespace compensation;
using scenarios::Scenario;
using Errors = std::vector<Eigen::Matrix3Xd>;

std::vector<std::string> thermometers_of(const Scenario& scenario) {
  std::vector<std::string> names;
  for (const scenarios::Sensor& s : scenario.machine->sensors) {
    if (!scenarios::is_on_ambient(s)) names.push_back(s.name);
  }
  return names;
}

/// Errors at the rings over the whole run, by a predictor.
struct Believed {
  std::string words;
  Errors rings_m;
};

/// The physics with a scattered model, scattered in the same way as the one of `run`.
compensation::Physics physics_for(const Scenario& scenario, const scenarios::Model& model, int repetition) {
  std::optional<compensation::Physics> physics = physics_of(scenario, model, 0.0, 0);
  if (physics) {
    physics->system = wrong_system(std::move(physics->system), *scenario.table, repetition);
    return *std::move(physics);
  }
  throw InputError(
      scenario.machine->where,
      "this predictor requires a linear reduced model: `solver: {model: reduced}`, and no law that follows temperatures");
}

Errors rings_of(const Scenario& scenario, const scenarios::Model& model, const MachineRun& felt,
                const solver::Trajectory& run, int repetition) {
  return table_course(scenario, scenarios::as_recorded(*scenario.machine, run, model.outputs(), felt.cyclogram),
                      wrong_expansions(*scenario.table, repetition))
      .rings_m;
}

Believed by_modes(const Scenario& scenario, const scenarios::Model& model, const MachineRun& felt,
                  const std::vector<double>& times_s, int repetition) {
  const compensation::Physics p = physics_for(scenario, model, repetition);
  return {"thermal modes of a model that is off, from the ambient alone",
          rings_of(scenario, model, felt,
                   solver::simulate(p.system, felt.cyclogram, felt.ambient, times_s, scenario.solver.transient, p.start),
                   repetition)};
}

Believed by_observer(const Scenario& scenario, const scenarios::Model& model, const MachineRun& felt, const Record& readings,
                     int repetition) {
  const compensation::Physics p = physics_for(scenario, model, repetition);
  const std::vector<std::string> sensors = thermometers_of(scenario);
  const Thermometers& instrument = scenario.table->instrument;
  const double reading_K =
      std::hypot(instrument.noise_K, instrument.resolution_K / std::sqrt(12.0));  // includes the rounding error
  const Observer observer(
      p.system, p.start, p.start_ambient_K, sensors, "table_1_x",
      {.reading_K = reading_K, .longest_step_s = 600.0, .period_s = readings.time_s.at(1) - readings.time_s.at(0)});
  const Observation seen = observer.observe({felt.cyclogram, felt.ambient, readings});
  solver::Trajectory run;
  run.time_s = readings.time_s;
  run.outputs = seen.outputs;
  return {fmt::format("the same model corrected by {}", fmt::join(sensors, ", ")),
          rings_of(scenario, model, felt, run, repetition)};
}

/// Each coordinate of each ring as a regression on a few thermometers, fitted to rings measured during training.
Believed by_regression(const Scenario& scenario, const TableCourse& truth, const Record& readings, int repetition) {
  const scenarios::TableSettings& s = *scenario.table;
  std::vector<std::string> sensors = thermometers_of(scenario);
  const auto n_rings = truth.rings_m.front().cols();
  Record training{
      .source = "rings measured from " + fmt::format("{:g} h on", s.train_from_s / 3600.0), .time_s = {}, .channels = {}};
  for (const std::string& name : sensors) training.channels.push_back({name, "degC", {}});
  for (Eigen::Index k = 0; k < 3 * n_rings; ++k) training.channels.push_back({fmt::format("ring_{}", k), "um", {}});
  const TableTraining measured = train(truth, s, repetition);
  for (std::size_t m = 0; m < measured.rows.size(); ++m) {
    training.time_s.push_back(readings.time_s[measured.rows[m]]);
    for (std::size_t c = 0; c < sensors.size(); ++c)
      training.channels[c].values.push_back(readings.at(sensors[c]).values[measured.rows[m]]);
    for (Eigen::Index k = 0; k < 3 * n_rings; ++k)
      training.channels[sensors.size() + static_cast<std::size_t>(k)].values.push_back(1e6 *
                                                                                       measured.rings_m[m].reshaped()(k));
  }
  // As many thermometers as the few measurements allow.
  const int n_sensors = std::max(1, static_cast<int>(training.n_samples()) / 4);
  Believed believed{"", Errors(readings.n_samples(), Eigen::Matrix3Xd::Zero(3, n_rings))};
  std::vector<std::string> used;
  for (Eigen::Index k = 0; k < 3 * n_rings; ++k) {
    const std::string target = fmt::format("ring_{}", k);
    const Selection selection = select_by_correlation(std::span(&training, 1), sensors, target, n_sensors);
    const std::vector<double> um = fit_regression(std::span(&training, 1), selection.sensors, target).predict(readings);
    for (std::size_t i = 0; i < um.size(); ++i) believed.rings_m[i].reshaped()(k) = 1e-6 * um[i];
    for (const std::string& name : selection.sensors) {
      if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
    }
  }
  believed.words =
      fmt::format("regression on {} thermometer{} a coordinate ({}), fitted to {} measurements from {:g} h on", n_sensors,
                  n_sensors == 1 ? "" : "s", fmt::join(used, ", "), training.n_samples(), s.train_from_s / 3600.0);
  return believed;
}

}  // namespace

FrameStudy correct_through_frame(const Scenario& scenario, const std::string& model_name, const Listener& listener) {
  const scenarios::TableSettings& s = *scenario.table;
  const Cyclogram& cyclogram = scenario.cyclogram(s.cyclogram);
  const scenarios::Model model = scenarios::open_model(scenario, {&cyclogram}, listener, false);
  TableCourse truth = table_course(
      scenario, std::move(scenarios::simulate_cyclograms(scenario, model, {&cyclogram}, listener).front().record));
  listener.begin("correcting");
  const MachineRun felt = scenarios::felt_run(*scenario.machine, cyclogram);
  std::vector<Believed> believed;
  for (int k = 0; k < kTableRepetitions; ++k) {
    const Record readings = table_readings(scenario, felt, truth.record, k);
    believed.push_back(model_name == "modes"      ? by_modes(scenario, model, felt, readings.time_s, k)
                       : model_name == "observer" ? by_observer(scenario, model, felt, readings, k)
                                                  : by_regression(scenario, truth, readings, k));
  }

  const auto n = static_cast<std::size_t>(
      std::upper_bound(truth.table.time_s.begin(), truth.table.time_s.end(), s.judge_until_s + 1e-6) -
      truth.table.time_s.begin());
  const auto first = [&](auto rows) {
    rows.resize(std::min(rows.size(), n));
    return rows;
  };
  const TableErrors table{first(truth.table.time_s), truth.table.points_m, first(truth.table.error_m)};
  const Errors rings_m = first(truth.rings_m);
  std::vector<Eigen::Vector3d> places;
  for (const scenarios::TableRing& ring : s.rings) places.push_back(ring.at_m);
  const auto predicted_m = [&](int k) { return first(believed[static_cast<std::size_t>(k)].rings_m); };
  const auto left = [&](const Errors& at_rings_m) { return through_frame(table, places, at_rings_m).left_m; };
  const auto plan = [&](int k) { return ring_plan(s, s.every_s, k); };
  std::vector<TableStrategy> rows = {repeated("none", [&](int) { return table.error_m; }),
                                     repeated(fmt::format("rings every {:g} min", s.every_s / 60.0),
                                              [&](int k) { return left(held_rings(table.time_s, rings_m, plan(k))); }),
                                     repeated(model_name, [&](int k) { return left(predicted_m(k)); }),
                                     repeated(fmt::format("rings, {} between", model_name), [&](int k) {
                                       return left(carried_rings(table.time_s, rings_m, predicted_m(k), plan(k)));
                                     })};
  return {.predictor = believed.front().words, .time_s = table.time_s, .corrections = std::move(rows)};
}

}  // namespace driftwright::studies
