#include "machine/reduced_machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "machine/body_parts.hpp"
#include "machine/travel.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/conduction_factor.hpp"
#include "solver/reduced_model.hpp"
#include "solver/steady_state.hpp"

namespace driftwright::scenarios {
namespace {

bool has_curves(const solver::RegionMaterials& materials) {
  return std::any_of(materials.begin(), materials.end(), [](const solver::Material& m) {
    return !m.conductivity_curve.empty() || !m.heat_capacity_curve.empty();
  });
}

/// The demand of a system whose last exchanges, with the coefficient 1, replace prescribed temperatures.
solver::ReductionDemand with_prescriptions(solver::ReductionDemand demand, std::size_t n_exchanges) {
  const auto n = static_cast<Eigen::Index>(n_exchanges), before = demand.low.size();
  demand.low.conservativeResize(n);
  demand.high.conservativeResize(n);
  demand.low.tail(n - before).setOnes();
  demand.high.tail(n - before).setOnes();
  return demand;
}

/// Materials with conductivity and capacity at each region's mean temperature, in the steady state of half the
/// demanded power, with coefficients in the middle of their ranges.
solver::RegionMaterials at_work(const Machine& machine, const effects::HeatBalance& balance,
                                const solver::FullSystem& system, const solver::ReductionDemand& demand, double ambient_K) {
  const Eigen::VectorXd c = demand.points().front();
  solver::SparseRow k = system.conduction;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(system.size());
  for (std::size_t e = 0; e < system.exchanges.size(); ++e) {
    const auto& exchange = system.exchanges[e];
    const double coefficient = c[static_cast<Eigen::Index>(e)];
    k += coefficient * exchange.matrix;
    load += coefficient * ambient_K * exchange.to_ambient;
    if (exchange.offset.size() > 0) load += coefficient * exchange.offset;
  }
  for (std::size_t s = 0; s < system.sources.size(); ++s) {
    load += 0.5 * demand.power_W[static_cast<Eigen::Index>(s)] * system.sources[s].load;
  }
  solver::require_way_out(k);
  const Eigen::VectorXd theta = solver::ConductionFactor(k).solve(load);
  solver::RegionMaterials materials = machine.placed.materials;
  for (std::size_t r = 0; r < materials.size(); ++r) {
    const effects::Body region = effects::region(machine.placed.mesh.regions[r]);
    const double t_K = system.reference_K + solver::mean_weights(machine.placed.mesh, balance, region).dot(theta);
    solver::Material& m = materials[r];
    if (!m.conductivity_curve.empty()) m.conductivity_W_mK = m.conductivity_curve.at(t_K);
    if (!m.heat_capacity_curve.empty()) m.heat_capacity_J_kgK = m.heat_capacity_curve.at(t_K);
    m.conductivity_curve = {};
    m.heat_capacity_curve = {};
  }
  return materials;
}

/// The full system without the terms that cannot be projected.
/// @param materials  with frozen properties
solver::FullSystem reducible_system(const MachineModel& model, const Machine& machine, const effects::HeatBalance& balance,
                                    const solver::ReductionDemand& demand, solver::RegionMaterials& materials) {
  for (const solver::FixedUnknowns& f : machine.system.fixed) {
    if (!f.follows_ambient && f.theta.value.size() > 1) {
      throw InputError(model.where, fmt::format("{} is prescribed over time; no reduced model follows it. Take `solver: "
                                                "{{model: full}}`",
                                                f.name));
    }
  }
  const mesh::Mesh& mesh = machine.placed.mesh;
  solver::FullSystem system = machine.system;
  if (!system.nonlinear.empty() || system.capacity) {
    for (solver::Material& m : materials) {  // first at the reference temperature
      if (!m.conductivity_curve.empty()) m.conductivity_W_mK = m.conductivity_curve.at(model.reference_K);
      if (!m.heat_capacity_curve.empty()) m.heat_capacity_J_kgK = m.heat_capacity_curve.at(model.reference_K);
      m.conductivity_curve = {};
      m.heat_capacity_curve = {};
    }
    const auto assemble = [&] {
      solver::FullSystem assembled = solver::assemble_heat(mesh, materials, balance, model.reference_K);
      solver::hold_by_exchanges(assembled);
      return assembled;
    };
    system = assemble();
    if (has_curves(machine.placed.materials)) {
      materials = at_work(machine, balance, system, with_prescriptions(demand, system.exchanges.size()),
                          felt_ambient_at_start_K(model));
      system = assemble();
    }
    system.outputs = machine.system.outputs;
    return system;
  }
  solver::hold_by_exchanges(system);
  return system;
}

std::optional<compensation::ModalPredictors> modal_predictors(const solver::FullSystem& system, const Eigen::VectorXd& start,
                                                              double ambient_K, const ReductionPlan& plan) {
  if (!system.thermostats.empty() || plan.n_modes == 0) return std::nullopt;
  solver::FullSystem frozen = system;
  if (system.looks_at_state()) {
    const effects::Inputs at{.drive = plan.typical, .ambient_K = ambient_K};
    solver::freeze_laws(frozen, at, solver::steady_state(system, at, start));
  }
  return compensation::make_modal_predictors(frozen, plan.n_modes, start, ambient_K, plan.typical);
}

}  // namespace

ReductionPlan reduction_plan(const Scenario& scenario, const std::vector<const Cyclogram*>& cyclograms) {
  const MachineModel& model = *scenario.machine;
  const effects::HeatBalance balance = effects::with_radiation_as_films(effects::heat_balance(model.effects));
  std::vector<MachineRun> felt;
  for (const Cyclogram* cyclogram : cyclograms) felt.push_back(felt_run_as_far_as_known(model, *cyclogram));
  std::vector<const Cyclogram*> driven;
  for (const MachineRun& run : felt) driven.push_back(&run.cyclogram);
  ReductionPlan plan;
  plan.demand = solver::reduction_demand(balance, driven, model.ambient, model.reference_K);
  const bool moves_ambient = std::any_of(model.effects.begin(), model.effects.end(), effects::changes_drive);
  if (moves_ambient) {  // each run may have another ambient
    for (const MachineRun& run : felt) {
      plan.demand.include(solver::reduction_demand(balance, {&run.cyclogram}, run.ambient, model.reference_K));
    }
  }
  plan.tolerance_K = scenario.solver.reduction_tolerance_K;
  plan.with_fields = scenario.solver.fields_format != FieldsFormat::kNone;
  plan.with_parts = says_known_to(model);  // for the bands about its curves
  std::vector<Cyclogram> typical;
  for (const Cyclogram& c : scenario.cyclograms) {
    const bool trains = !scenario.study || std::find(scenario.study->train.begin(), scenario.study->train.end(), c.name) !=
                                               scenario.study->train.end();
    if (trains) typical.push_back(felt_run_as_far_as_known(model, c).cyclogram);
  }
  std::vector<const Cyclogram*> pointers;
  for (const Cyclogram& c : typical) pointers.push_back(&c);
  plan.typical = mean_drive(pointers);
  if (scenario.study) plan.n_modes = scenario.study->thermal_modes;
  return plan;
}

Eigen::VectorXd ReducedMachine::node_temperature_K(const Eigen::VectorXd& state) const {
  if (travel) return travel->temperature.topRows(mesh.n_nodes()) * state;
  return (temperature * state.cast<float>()).cast<double>();
}

Eigen::Matrix3Xd ReducedMachine::node_displacement_m(const Eigen::VectorXd& state) const {
  const Eigen::VectorXd u = (displacement_m * state.cast<float>()).cast<double>();
  return Eigen::Map<const Eigen::Matrix3Xd>(u.data(), 3, u.size() / 3);
}

ReducedMachine reduce(const MachineModel& model, const Machine& machine, const ReductionPlan& plan,
                      const Listener& listener) {
  const effects::HeatBalance balance = effects::with_radiation_as_films(machine.placed.balance);
  solver::RegionMaterials materials = machine.placed.materials;
  solver::FullSystem system = reducible_system(model, machine, balance, plan.demand, materials);
  if (plan.with_parts) system.parts = body_parts(model, machine, materials, balance);
  const double ambient_K = felt_ambient_at_start_K(model);
  Eigen::VectorXd start = start_state(model, machine);
  for (const solver::FixedUnknowns& f : machine.system.fixed) {  // prescribed temperatures jump at once, as in simulate()
    for (int i : f.unknowns) start[i] = f.follows_ambient ? ambient_K : f.theta.at(0.0);
  }
  const solver::ReductionOptions options{
      .temperature_K = plan.tolerance_K, .displacement_m = 2e-6 * plan.tolerance_K, .angle_rad = 2e-5 * plan.tolerance_K};
  const solver::ReductionDemand demand = with_prescriptions(plan.demand, system.exchanges.size());
  std::shared_ptr<Travel> travel;
  solver::Reduction reduction;
  if (plan.moves.empty()) {
    reduction = solver::reduce(system, demand, start, options);
  } else {
    TravelReduction over = reduce_over_travel(model, machine, std::make_shared<const solver::FullSystem>(system), start,
                                              demand, options, plan.moves, listener);
    reduction = std::move(over.reduction);
    travel = std::make_shared<Travel>(std::move(over.travel));
  }
  ReducedMachine reduced{.mesh = machine.placed.mesh,
                         .n_unknowns = system.size(),
                         .system = solver::project(system, reduction.basis),
                         .start = reduction.basis.transpose() * (system.mass * start),
                         .error = reduction.error,
                         .modal = modal_predictors(system, start, ambient_K, plan),
                         .temperature = {},
                         .displacement_m = {},
                         .travel = std::move(travel)};
  const int n_nodes = machine.placed.mesh.n_nodes();
  if (!plan.with_fields || !machine.elasticity) return reduced;
  reduced.temperature = reduction.basis.topRows(n_nodes).cast<float>();
  reduced.displacement_m.resize(3 * n_nodes, reduction.basis.cols());
  for (Eigen::Index c = 0; c < reduction.basis.cols(); ++c) {
    const Eigen::Matrix3Xd u = machine.elasticity->displacement(reduction.basis.col(c));
    reduced.displacement_m.col(c) = Eigen::Map<const Eigen::VectorXd>(u.data(), u.size()).cast<float>();
  }
  return reduced;
}

}  // namespace driftwright::scenarios
