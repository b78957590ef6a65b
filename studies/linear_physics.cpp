#include "studies/linear_physics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "compensation/judging/model_scatter.hpp"
#include "compensation/predictors/modal_predictor.hpp"
#include "compensation/predictors/scored_rows.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/reduced_transient.hpp"

namespace driftwright::studies {
namespace {

using compensation::Physics;
using scenarios::Scenario;

constexpr int kModesOfObserver = 12;  // the slowest modes of the model, in addition to its steady responses

Physics physics_from(const Scenario& scenario, const solver::ReducedSystem& linear, const Eigen::VectorXd& start,
                     double ambient_K, double scatter, int seed) {
  const compensation::ModalPredictor modes =
      compensation::make_ritz_predictor(linear, start, kModesOfObserver, {.drive = {}, .ambient_K = ambient_K});
  return {.system = compensation::scattered(modes.system, scatter, seed, true),
          .start = modes.start,
          .start_ambient_K = ambient_K,
          .laws = scenario.machine->effects};
}

Eigen::Index output_index(const solver::ReducedSystem& system, const std::string& name) {
  const auto found = std::find(system.outputs.name.begin(), system.outputs.name.end(), name);
  if (found == system.outputs.name.end())
    throw InputError(fmt::format("the scenario's machine has no displacement '{}'", name));
  return found - system.outputs.name.begin();
}

/// The drift of a reduced system during a run, and the rows at which laws are linearised.
struct ModelDrift {
  Eigen::VectorXd drift_um;  ///< since its first row
  std::vector<solver::OperatingRow> rows;
};
ModelDrift model_drift(const solver::ReducedSystem& system, const Eigen::VectorXd& start, double start_ambient_K,
                       Eigen::Index target, const solver::TransientOptions& options, const MachineRun& run) {
  const std::vector<double>& times_s = run.readings.time_s;
  const double warmer_K = run.ambient.at(times_s.front()) - start_ambient_K;
  ModelDrift result;
  const solver::Trajectory trajectory = solver::simulate(
      system, run.cyclogram, run.ambient, times_s, options, start + warmer_K * system.ones,
      [&](double t_s, const Eigen::VectorXd& state) {
        effects::Inputs at{.drive = run.cyclogram.drive(t_s), .ambient_K = run.ambient.at(t_s), .time_s = t_s};
        at.run = run.cyclogram.name;
        result.rows.push_back({std::move(at), state});
      });
  const Eigen::VectorXd output = trajectory.outputs.row(target).transpose();
  result.drift_um = 1e6 * (output.array() - output[0]);
  return result;
}

}  // namespace

std::optional<Physics> physics_of(const Scenario& scenario, const scenarios::Model& model, double scatter, int seed) {
  const scenarios::ReducedMachine* reduced = model.reduced();
  if (!reduced || !reduced->system.is_linear()) return std::nullopt;
  return physics_from(scenario, reduced->system, reduced->start, scenarios::felt_ambient_at_start_K(*scenario.machine),
                      scatter, seed);
}

LinearPhysics linear_physics(const Scenario& scenario, const scenarios::Model& model, std::span<const MachineRun> runs,
                             double scatter, int seed) {
  const scenarios::ReducedMachine* reduced = model.reduced();
  if (!reduced)
    return {std::nullopt,
            "they need the reduced model, and the scenario asks for the full one; `solver: {model: reduced}` is required"};
  const solver::ReducedSystem& system = reduced->system;
  if (!system.thermostats.empty())
    return {std::nullopt, fmt::format("they need a linear model, and thermostat '{}' of the scenario's machine switches",
                                      system.thermostats.front().name)};
  if (std::optional<Physics> exact = physics_of(scenario, model, scatter, seed)) return {std::move(exact), ""};

  const std::string& name = scenario.study->target;
  const Eigen::Index target = output_index(system, name);
  const double ambient_K = scenarios::felt_ambient_at_start_K(*scenario.machine);
  const auto run_of = [&](const solver::ReducedSystem& of, const MachineRun& run) {
    return model_drift(of, reduced->start, ambient_K, target, scenario.solver.transient, run);
  };
  const std::vector<MachineRun> whole = compensation::joined_histories(runs, name);
  std::vector<solver::OperatingRow> rows;
  std::vector<Eigen::VectorXd> nonlinear_um;
  for (const MachineRun& run : whole) {
    ModelDrift nonlinear = run_of(system, run);
    std::move(nonlinear.rows.begin(), nonlinear.rows.end(), std::back_inserter(rows));
    nonlinear_um.push_back(std::move(nonlinear.drift_um));
  }
  try {
    solver::Linearisation linear = solver::linearise(system, rows);
    compensation::LinearisedModel lost{.laws = std::move(linear.laws)};
    for (std::size_t r = 0; r < whole.size(); ++r) {
      const Eigen::VectorXd drift_um = run_of(linear.system, whole[r]).drift_um;
      if (!drift_um.allFinite())
        return {std::nullopt, "the model that is linearised about the training runs grows without bounds in them"};
      lost.error_um = std::max(lost.error_um, (drift_um - nonlinear_um[r]).cwiseAbs().maxCoeff());
      lost.drift_um = std::max(lost.drift_um, nonlinear_um[r].cwiseAbs().maxCoeff());
    }
    Physics physics = physics_from(scenario, linear.system, reduced->start, ambient_K, scatter, seed);
    physics.linearised = std::move(lost);
    return {std::move(physics), ""};
  } catch (const RangeError& e) {
    return {std::nullopt, fmt::format("the model cannot be linearised about the training runs: {}", e.what())};
  }
}

}  // namespace driftwright::studies
