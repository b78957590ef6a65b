#include "studies/placement_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "compensation/judging/model_scatter.hpp"
#include "compensation/predictors/observer.hpp"
#include "solver/propagator.hpp"
#include "solver/reduced_transient.hpp"

namespace driftwright::studies {
namespace {

constexpr double kStep = 0.01;            // relative change of a factor, for its derivative
constexpr double kAtWork_s = 8 * 3600.0;  // time at the mean drive after which laws of temperature are frozen
constexpr const char* kNodeSensor = "placement_node_";

/// The scenario prepared for the model: reduced, with fields, and without a mesh with thermometers on its lumped nodes.
scenarios::Scenario prepared(scenarios::Scenario scenario, const std::vector<std::string>& nodes) {
  scenario.solver.model = scenarios::ModelKind::kReduced;
  if (scenario.solver.fields_format == FieldsFormat::kNone) scenario.solver.fields_format = FieldsFormat::kVtu;
  for (const std::string& node : nodes)
    scenario.machine->sensors.push_back({.name = kNodeSensor + node, .place = node, .where = {}});
  return scenario;
}

std::vector<std::string> lumped_nodes(const scenarios::MachineModel& machine) {
  std::vector<std::string> names;
  if (!std::holds_alternative<scenarios::LumpedMachine>(machine.mesh)) return names;
  for (const effects::LumpedNode& node : effects::heat_balance(machine.effects).nodes) names.push_back(node.name);
  return names;
}

/// Freezes laws of temperature at the state of the machine at work.
void linearise(solver::ReducedSystem& system, const Eigen::VectorXd& start, const scenarios::Scenario& scenario,
               const std::vector<const Cyclogram*>& cyclograms) {
  if (!system.thermostats.empty())
    throw InputError(
        scenario.machine->where,
        fmt::format("`place` cannot treat this machine: thermostat '{}' switches on and off, and places are chosen with a "
                    "linear model. Run it on a copy of the scenario in which the `coolant` has no `set_point`, "
                    "`cooling_power` and `hysteresis`",
                    system.thermostats.front().name));
  const double ambient_K = scenarios::felt_ambient_at_start_K(*scenario.machine);
  const Cyclogram work{.name = "work", .sections = {{kAtWork_s, mean_drive(cyclograms)}}};
  Eigen::VectorXd state = start;
  (void)solver::simulate(system, work, {{0.0}, {ambient_K}}, {kAtWork_s}, scenario.solver.transient, start,
                         [&](double, const Eigen::VectorXd& z) { state = z; });
  const auto freeze = [&](solver::BoundLaw& law) {
    for (int p : law.probes)
      law.frozen_K.push_back(system.reference_K + system.probes[static_cast<std::size_t>(p)].theta_K(state, ambient_K));
    law.probes.clear();
  };
  for (solver::HeatSource& source : system.sources) freeze(source.power_W);
  for (auto& exchange : system.exchanges) freeze(exchange.coefficient);
}

Eigen::Index output_of(const solver::ReducedSystem& system, const std::string& name) {
  const auto& names = system.outputs.name;
  return std::find(names.begin(), names.end(), name) - names.begin();
}

/// The index of an output; the error lists the existing ones.
Eigen::Index known_output(const solver::ReducedSystem& system, const std::string& option, const std::string& name,
                          bool temperature) {
  std::vector<std::string> known;
  for (std::size_t i = 0; i < system.outputs.name.size(); ++i) {
    const std::string& other = system.outputs.name[i];
    if ((system.outputs.unit[i] == "K") == temperature && !other.starts_with(kNodeSensor)) known.push_back(other);
  }
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw InputError(fmt::format("{} '{}': the machine has no such {}; there are {}.{}", option, name,
                                 temperature ? "sensor" : "displacement", fmt::join(known, ", "),
                                 did_you_mean(name, known)));
  return output_of(system, name);
}

solver::ReducedSystem with_factor(const solver::ReducedSystem& system, std::size_t at, double factor) {
  const std::size_t n_flows = system.sources.size() + system.exchanges.size();
  std::vector<double> flow(n_flows, 1.0);
  if (at < n_flows) flow[at] = factor;
  solver::ModelFactors factors = solver::flow_factors(system, flow);
  if (at == n_flows) factors.conduction = factor;
  if (at == n_flows + 1) factors.rate = factor;
  return solver::with_factors(system, factors);
}

}  // namespace

std::vector<int> PlacementModel::mounted() const {
  std::vector<int> last;
  for (int i = 0; i < n_mounted; ++i) last.push_back(n_free() + i);
  return last;
}

PlacementModel placement_model(const scenarios::Scenario& scenario, const std::vector<const Cyclogram*>& cyclograms,
                               const SpotRules& rules, const std::vector<std::string>& mounted,
                               const std::vector<std::string>& channels, const Listener& listener) {
  const std::vector<std::string> nodes = lumped_nodes(*scenario.machine);
  PlacementModel model{.opened = scenarios::open_model(prepared(scenario, nodes), cyclograms, listener, true),
                       .system = {},
                       .start = {},
                       .spots = {},
                       .rows = {},
                       .ambient = {},
                       .drifts = {},
                       .channels = {},
                       .regions = {},
                       .left_out = {}};
  const scenarios::ReducedMachine& reduced = *model.opened.reduced();
  model.system = reduced.system;
  model.start = reduced.start;
  model.start_ambient_K = scenarios::felt_ambient_at_start_K(*scenario.machine);
  if (!model.system.is_linear()) {
    linearise(model.system, model.start, scenario, cyclograms);
    model.is_linearised = true;
  }
  Spots spots = nodes.empty() ? spots_of(reduced.mesh, rules) : spots_of(nodes, rules);
  model.regions = std::move(spots.regions);
  model.left_out = std::move(spots.left_out);
  model.spots = std::move(spots.points);
  for (Spot& spot : model.spots) spot.at_m = scenarios::motion_of(scenario.machine->axes, spot.region).before(spot.at_m);
  for (const std::string& name : mounted) {
    (void)known_output(model.system, "--mounted", name, true);
    model.spots.push_back({.sensor = name});
    ++model.n_mounted;
  }
  model.n_candidates = static_cast<int>(model.spots.size());
  for (const scenarios::Sensor& sensor : scenario.machine->sensors) {
    if (!scenarios::is_on_ambient(sensor) && std::find(mounted.begin(), mounted.end(), sensor.name) == mounted.end())
      model.spots.push_back({.sensor = sensor.name});
  }
  model.rows.resize(static_cast<Eigen::Index>(model.spots.size()), model.system.size());
  model.ambient = Eigen::VectorXd::Zero(model.rows.rows());
  for (Eigen::Index i = 0; i < model.rows.rows(); ++i) {
    Spot& spot = model.spots[static_cast<std::size_t>(i)];
    if (spot.node >= 0) {
      model.rows.row(i) = reduced.temperature.row(spot.node).cast<double>();
      continue;
    }
    const Eigen::Index output = output_of(model.system, spot.sensor.empty() ? kNodeSensor + spot.region : spot.sensor);
    model.rows.row(i) = model.system.outputs.state.col(output).transpose();
    model.ambient[i] = model.system.outputs.ambient[output];
    for (const scenarios::Sensor& sensor : scenario.machine->sensors) {
      if (sensor.name != spot.sensor) continue;
      if (const auto* point = std::get_if<scenarios::PointOnRegion>(&sensor.place)) {
        spot.region = point->region;
        spot.at_m = point->at_m;
      } else {
        spot.region = std::get<std::string>(sensor.place);
      }
    }
  }
  std::vector<std::string> asked = channels;
  if (asked.empty() && scenario.study) asked = {scenario.study->target};
  if (asked.empty()) {
    for (const scenarios::DisplacementOutput& output : scenario.machine->displacements) asked.push_back(output.name);
  }
  if (asked.empty())
    throw InputError(scenario.machine->where,
                     "the scenario has no displacement; thermometers are placed for the sake of one");
  for (const std::string& name : asked) {
    const Eigen::Index output = known_output(model.system, "--channel", name, false);
    if (model.system.outputs.unit[static_cast<std::size_t>(output)] != "m")
      throw InputError(fmt::format("--channel '{}' is a tilt; places are chosen for displacements", name));
    model.drifts.push_back(output);
    model.channels.push_back(name);
  }
  return model;
}

Eigen::MatrixXd states_of(const PlacementModel& model, const solver::ReducedSystem& system, const MachineRun& run) {
  const double warmer_K = run.ambient.at(0.0) - model.start_ambient_K;
  Eigen::MatrixXd states;
  solver::Propagator propagator(system);
  (void)propagator.run(run.cyclogram, run.ambient, run.readings.time_s, model.start + warmer_K * system.ones, false,
                       &states);
  return states;
}

Eigen::MatrixXd drift_um(const PlacementModel& model, const MachineRun& run, const Eigen::MatrixXd& states) {
  const Eigen::VectorXd start = model.start + (run.ambient.at(0.0) - model.start_ambient_K) * model.system.ones;
  Eigen::MatrixXd drift(states.cols(), static_cast<Eigen::Index>(model.drifts.size()));
  for (std::size_t d = 0; d < model.drifts.size(); ++d) {
    const Eigen::Index output = model.drifts[d];
    const Eigen::VectorXd row = model.system.outputs.state.col(output);
    const double ambient_share = model.system.outputs.ambient[output];
    for (Eigen::Index i = 0; i < states.cols(); ++i) {
      const double ambient_K = run.ambient.at(run.readings.time_s[static_cast<std::size_t>(i)]) - run.ambient.at(0.0);
      drift(i, static_cast<Eigen::Index>(d)) = 1e6 * (row.dot(states.col(i) - start) + ambient_share * ambient_K);
    }
  }
  return drift;
}

std::vector<std::string> factor_names(const PlacementModel& model) {
  std::vector<std::string> names = solver::flow_names(model.system);
  names.emplace_back("conduction");
  names.emplace_back("rate");
  return names;
}

std::vector<std::vector<Eigen::MatrixXd>> factor_states(const PlacementModel& model, const std::vector<MachineRun>& runs) {
  const std::size_t n_factors = factor_names(model).size();
  std::vector<Eigen::MatrixXd> nominal(runs.size());
  parallel_for(runs.size(), [&](std::size_t r) { nominal[r] = states_of(model, model.system, runs[r]); });
  std::vector<std::vector<Eigen::MatrixXd>> by_factor(runs.size(), std::vector<Eigen::MatrixXd>(n_factors));
  parallel_for(n_factors, [&](std::size_t f) {
    const solver::ReducedSystem changed = with_factor(model.system, f, 1.0 + kStep);
    for (std::size_t r = 0; r < runs.size(); ++r)
      by_factor[r][f] = (states_of(model, changed, runs[r]) - nominal[r]) / std::log1p(kStep);
  });
  return by_factor;
}

std::vector<compensation::RunSensitivity> sensitivities(const PlacementModel& model, const std::vector<MachineRun>& runs,
                                                        const std::vector<std::vector<Eigen::MatrixXd>>& by_factor,
                                                        double noise_K, const Eigen::MatrixXd& rows) {
  const compensation::ObserverSettings usual;
  Eigen::MatrixXd drifts(static_cast<Eigen::Index>(model.drifts.size()), model.system.size());
  for (std::size_t d = 0; d < model.drifts.size(); ++d)
    drifts.row(static_cast<Eigen::Index>(d)) = 1e6 * model.system.outputs.state.col(model.drifts[d]).transpose();
  std::vector<compensation::RunSensitivity> result(runs.size());
  parallel_for(runs.size(), [&](std::size_t r) {
    const std::vector<double>& times_s = runs[r].readings.time_s;
    const double step_s = times_s.size() > 1 ? times_s[1] - times_s[0] : usual.period_s;
    result[r].reading_K2 = noise_K * noise_K + usual.model_K * usual.model_K * std::max(1.0, usual.model_holds_s / step_s);
    for (const Eigen::MatrixXd& states : by_factor[r]) {
      result[r].reading_K.emplace_back(rows * states);
      result[r].drift_um.emplace_back(drifts * states);
    }
  });
  return result;
}

std::vector<std::vector<Eigen::MatrixXd>> scattered_states(const PlacementModel& model, const std::vector<MachineRun>& runs,
                                                           const std::vector<double>& scatter,
                                                           const std::vector<int>& seeds) {
  std::vector<std::vector<Eigen::MatrixXd>> states(scatter.size() * seeds.size(), std::vector<Eigen::MatrixXd>(runs.size()));
  parallel_for(states.size(), [&](std::size_t m) {
    const solver::ReducedSystem other =
        compensation::scattered(model.system, scatter[m / seeds.size()], seeds[m % seeds.size()], true);
    for (std::size_t r = 0; r < runs.size(); ++r) states[m][r] = states_of(model, other, runs[r]);
  });
  return states;
}

std::vector<compensation::RunOfCandidates> scattered_runs(const PlacementModel& model, const std::vector<MachineRun>& runs,
                                                          std::size_t n_ambients,
                                                          const std::vector<std::vector<Eigen::MatrixXd>>& states,
                                                          const Eigen::MatrixXd& rows, const Eigen::VectorXd& ambient) {
  std::vector<compensation::RunOfCandidates> result(states.size() * runs.size());
  parallel_for(result.size(), [&](std::size_t i) {
    const std::size_t m = i / runs.size(), r = i % runs.size();
    const double warmer_K = runs[r].ambient.at(0.0) - model.start_ambient_K;
    compensation::RunOfCandidates& run = result[i];
    run.machine = static_cast<int>(m);
    run.group = static_cast<int>(r / n_ambients);
    run.reading_K = rows * (states[m][r].colwise() - (model.start + warmer_K * model.system.ones));
    for (Eigen::Index k = 0; k < run.reading_K.cols(); ++k)
      run.reading_K.col(k) +=
          (runs[r].ambient.at(runs[r].readings.time_s[static_cast<std::size_t>(k)]) - runs[r].ambient.at(0.0)) * ambient;
    run.drift_um = drift_um(model, runs[r], states[m][r]);
  });
  return result;
}

}  // namespace driftwright::studies
