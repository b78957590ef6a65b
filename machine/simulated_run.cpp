#include "machine/simulated_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <exception>

#include "base/parallel.hpp"
#include "base/quantity.hpp"
#include "machine/as_recorded.hpp"
#include "machine/driven_before.hpp"
#include "machine/moving_run.hpp"
#include "machine/run_record.hpp"
#include "machine/travel.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "scenarios/reader/unusual.hpp"
#include "solver/energy_balance.hpp"
#include "solver/reduced_transient.hpp"
#include "solver/share.hpp"
#include "solver/stage_ode.hpp"

namespace driftwright::scenarios {

namespace {

/// The output times at which whole fields are computed.
class FieldTimes {
 public:
  FieldTimes(const SolverSettings& settings, double end_s) : settings_(settings), end_s_(end_s) {}
  bool is_due(double time_s) {
    const auto& wanted_s = settings_.fields_at_s;
    const bool listed =
        std::any_of(wanted_s.begin(), wanted_s.end(), [&](double t_s) { return std::abs(t_s - time_s) <= 1e-9 * t_s; });
    const bool due = wanted_s.empty() ? time_s >= next_s_ - 1e-6 : listed || time_s == 0.0;
    if (!due && time_s < end_s_) return false;
    while (next_s_ <= time_s + 1e-6) next_s_ += settings_.fields_every_s;
    return true;
  }

 private:
  const SolverSettings& settings_;
  double end_s_, next_s_ = 0.0;
};

bool follows_moves(const MachineModel& machine, const Model& model, const Cyclogram& cyclogram) {
  return (model.full() || model.reduced()->travel) && moves_axes(machine.axes, cyclogram);
}

/// felt_run(), of a model that follows moves also while axes move.
MachineRun followed_run(const MachineModel& machine, const Model& model, const Cyclogram& cyclogram) {
  if (!follows_moves(machine, model, cyclogram)) return felt_run(machine, cyclogram);
  require_columns(machine, cyclogram);
  return felt_run_as_far_as_known(machine, cyclogram);
}

/// The pose that a cyclogram has from a time on, as simulate_moving().
Pose pose_from(const MachineModel& machine, const Cyclogram& cyclogram, double time_s) {
  const std::vector<PoseStretch> stretches = pose_stretches(machine.axes, cyclogram);
  const auto at =
      std::find_if(stretches.begin(), stretches.end(), [&](const auto& s) { return time_s < s.end_s * (1.0 - 1e-12); });
  return (at == stretches.end() ? stretches.back() : *at).pose;
}

/// Displacements of all nodes at the pose that the cyclogram has at a time. @param nodes_K  temperatures of the nodes
Eigen::Matrix3Xd displacement_m(const MachineModel& machine, const Model& model, const Cyclogram& cyclogram, double time_s,
                                const Eigen::VectorXd& state, const Eigen::VectorXd& nodes_K) {
  const bool moves = follows_moves(machine, model, cyclogram);
  if (const ReducedMachine* reduced = model.reduced()) {
    const PosedReduced* posed = moves ? reduced_at(machine, model, pose_from(machine, cyclogram, time_s)) : nullptr;
    return posed ? displacement_at(machine, *reduced, *posed, state) : reduced->node_displacement_m(state);
  }
  const PosedMachine* posed = moves ? posed_at(machine, model, pose_from(machine, cyclogram, time_s)) : nullptr;
  return (posed ? posed->elasticity : model.full()->elasticity)->displacement(nodes_K);
}

void write_fields(const Scenario& scenario, const Model& model, const solver::RegionMaterials& materials,
                  const Cyclogram& cyclogram, double time_s, const Eigen::VectorXd& state, const FieldSink& fields) {
  const ReducedMachine* reduced = model.reduced();
  const Eigen::VectorXd nodes =
      reduced ? reduced->node_temperature_K(state) : Eigen::VectorXd(state.head(model.mesh().n_nodes()));
  const Eigen::Matrix3Xd moved_m = displacement_m(*scenario.machine, model, cyclogram, time_s, state, nodes);
  WholeFields whole{.time_s = time_s,
                    .temperature_degC = (nodes.array() + (scenario.machine->reference_K - kZeroCelsius_K)).matrix(),
                    .displacement_um = 1e6 * moved_m};
  if (scenario.solver.stresses) whole.stress = solver::stress_field(model.mesh(), materials, moved_m, nodes);
  fields.take(whole);
}

/// Adds the heat of further patterns of a film to that of the first one: the film is one law, whatever it is made of.
void sum_parts(solver::Trajectory& run) {
  std::vector<solver::HeatFlow> flows;
  Eigen::Index n = 0;
  for (std::size_t j = 0; j < run.flows.size(); ++j) {
    const auto row = static_cast<Eigen::Index>(j);
    if (run.flows[j].continues && flows.back().kind == run.flows[j].kind) {
      run.heat_J.row(n - 1) += run.heat_J.row(row);
      continue;
    }
    flows.push_back(run.flows[j]);
    if (n != row) run.heat_J.row(n) = run.heat_J.row(row);
    ++n;
  }
  run.flows = std::move(flows);
  run.heat_J.conservativeResize(n, Eigen::NoChange);
}

double heat_capacity_J_K(const solver::FullSystem& system) {
  if (system.share) return system.share->sum(system.mass.sum());
  return system.ones.dot(system.mass * system.ones);
}

/// The largest source of heat or cooling when temperatures leave all bounds: "heat_source spindle is 1.5e+05 W at 6000 rpm;
/// "; "" if there is none.
std::string largest_heat(const effects::HeatBalance& balance, const Cyclogram& felt, const MachineModel& machine,
                         const solver::TemperatureOutOfBounds& failure) {
  effects::Inputs at{.drive = felt.drive(failure.time_s), .time_s = felt.clock_s + failure.time_s};
  at.run = felt.name;
  const double sign = failure.temperature_K > 0.0 ? 1.0 : -1.0;
  const effects::HeatInput* largest = nullptr;
  double most_W = 0.0;
  for (const effects::HeatInput& heat : balance.heats) {
    at.probe_K.assign(heat.power_W.probes.size(), machine.reference_K);
    try {
      if (const double power_W = sign * heat.power_W(at); power_W > most_W) most_W = power_W, largest = &heat;
    } catch (const RangeError&) {  // outside the range of its formula
    }
  }
  if (!largest) return "";
  return fmt::format("{} is {:.4g} W at {:g} rpm; ", largest->name, sign * most_W, at.drive.speed_rpm);
}

}  // namespace

SimulatedRun simulate_run(const MachineModel& machine, const solver::TransientOptions& options, const Model& model,
                          const Eigen::VectorXd& from, const Cyclogram& cyclogram, const std::vector<double>& times_s,
                          const solver::OutputCallback& at_output) {
  const bool moves = follows_moves(machine, model, cyclogram);
  const MachineRun felt = followed_run(machine, model, cyclogram);
  const auto run = [&](const auto& system) {
    try {
      if (moves) return simulate_moving(machine, options, model, from, cyclogram, felt, times_s, at_output);
      return solver::simulate(system, felt.cyclogram, felt.ambient, times_s, options, from, at_output);
    } catch (const solver::TemperatureOutOfBounds& e) {
      throw SolveError(fmt::format("cyclogram '{}': {}{}", cyclogram.name,
                                   largest_heat(model.balance, felt.cyclogram, machine, e), e.what()));
    } catch (const SolveError& e) {
      throw SolveError(fmt::format("cyclogram '{}': {}", cyclogram.name, e.what()));
    }
  };
  SimulatedRun simulated{.record = {},
                         .trajectory = model.reduced() ? run(model.reduced()->system) : run(model.full()->system)};
  const double capacity_J_K = model.reduced() ? model.reduced()->system.ones.squaredNorm()  // M = 1
                                              : heat_capacity_J_K(model.full()->system);
  sum_parts(simulated.trajectory);
  solver::require_balance(simulated.trajectory, capacity_J_K);
  simulated.record = as_recorded(machine, simulated.trajectory, model.outputs(), cyclogram);
  return simulated;
}

std::vector<std::string> unusual_results(std::span<const SimulatedRun> runs, const MachineModel& machine) {
  std::vector<std::string> found;
  for (const SimulatedRun& run : runs) {
    for (std::string& sentence : unusual_temperatures(run.bodies, machine, run.record.source))
      found.push_back(std::move(sentence));
    for (std::string& sentence : unusual_values(run.record, run.bodies.empty())) found.push_back(std::move(sentence));
  }
  return found;
}

Eigen::VectorXd start_of(const MachineModel& machine, const Model& model) {
  return model.reduced() ? model.reduced()->start : start_state(machine, *model.full());
}

Eigen::VectorXd after_what_was_before(const MachineModel& machine, const solver::TransientOptions& options,
                                      const Model& model, const Eigen::VectorXd& from, const Cyclogram& cyclogram) {
  const MachineRun felt = followed_run(machine, model, cyclogram);
  return model.reduced() ? after_what_was_before(model.reduced()->system, felt, options, from)
                         : after_what_was_before(model.full()->system, felt, options, from);
}

const Eigen::VectorXd& ones_of(const Model& model) {
  return model.reduced() ? model.reduced()->system.ones : model.full()->system.ones;
}

std::vector<SimulatedRun> simulate_cyclograms(const Scenario& scenario, const Model& model,
                                              const std::vector<const Cyclogram*>& cyclograms, const Listener& listener,
                                              const FieldSink& fields) {
  const MachineModel& machine = *scenario.machine;
  const SolverSettings& settings = scenario.solver;
  double total_s = 0.0;
  for (const Cyclogram* c : cyclograms) total_s += c->duration_s();
  listener.begin(fmt::format("simulating {} cyclogram{}, {:.0f} min in all", cyclograms.size(),
                             cyclograms.size() == 1 ? "" : "s", total_s / 60.0));

  solver::RegionMaterials materials;
  if (fields.take && settings.stresses) materials = region_materials(machine, model.mesh());
  const Eigen::VectorXd start = start_of(machine, model);
  std::vector<SimulatedRun> runs(cyclograms.size());
  double done_s = 0.0;
  // Runs are independent, so each runs on one core, including the loops inside it: no thread waits for
  // another, which matters on a busy machine. A single run uses all cores.
  const auto simulate_one = [&](std::size_t i) {
    const Cyclogram& cyclogram = *cyclograms[i];
    FieldTimes field_times(settings, cyclogram.duration_s());
    const std::vector<double> times_s = output_times_s(cyclogram, settings.output_interval_s, settings.fields_at_s);
    BodyRangeWatch watch(machine, model, times_s.size());
    double last_s = 0.0;
    const auto at_output = [&](double time_s, const Eigen::VectorXd& state) {
      watch.take(state);
      std::exception_ptr failure;  // no exception may leave the critical section
#pragma omp critical(simulated)
      try {
        listener.share((done_s += time_s - last_s) / total_s);
      } catch (...) {
        failure = std::current_exception();
      }
      if (failure) std::rethrow_exception(failure);
      last_s = time_s;
      if (fields.take && i == fields.cyclogram && field_times.is_due(time_s)) {
        write_fields(scenario, model, materials, cyclogram, time_s, state, fields);
      }
    };
    const Eigen::VectorXd from = after_what_was_before(
        machine, settings.transient, model, start + warmer_start_K(machine, cyclogram) * ones_of(model), cyclogram);
    runs[i] = simulate_run(machine, settings.transient, model, from, cyclogram, times_s, at_output);
    runs[i].bodies = watch.bodies();
  };
  if (model.full() && model.full()->system.share) {  // the processes must meet in the same run
    for (std::size_t i = 0; i < cyclograms.size(); ++i) simulate_one(i);
  } else {
    parallel_for(cyclograms.size(), simulate_one);
  }
  return runs;
}

}  // namespace driftwright::scenarios
