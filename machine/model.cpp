#include "machine/model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/version.hpp"
#include "machine/machine_key.hpp"
#include "machine/machine_store.hpp"
#include "machine/moving_run.hpp"
#include "machine/sources.hpp"
#include "machine/travel.hpp"
#include "machine/ways_out.hpp"
#include "scenarios/reader/felt_run.hpp"

namespace driftwright::scenarios {

std::string build_name() {
  return fmt::format("{} {}", kVersion, kSourcesOfMachines);
}

int n_fields(const Scenario& scenario) {
  if (!scenario.solver.fields_at_s.empty()) return static_cast<int>(scenario.solver.fields_at_s.size()) + 2;
  double longest_s = 0.0;
  for (const Cyclogram& c : scenario.cyclograms) longest_s = std::max(longest_s, c.duration_s());
  return static_cast<int>(std::min(1e6, longest_s / scenario.solver.fields_every_s)) + 2;
}

std::string Model::words() const {
  if (full()) return fmt::format("full model of {} temperature unknowns", n_unknowns());
  const solver::ReductionError& e = reduced()->error;
  const std::string over =
      reduced()->travel ? fmt::format(" over the travel, made from {} poses,", reduced()->travel->n_training) : "";
  return fmt::format(
      "reduced model of {} states for {} unknowns{} estimated to miss the full one by at most {:.2g} K, {:.2g} µm and "
      "{:.2g} µrad",
      reduced()->system.size(), n_unknowns(), over.empty() ? "," : over, e.temperature_K, 1e6 * e.displacement_m,
      1e6 * e.angle_rad);
}

compensation::ModalPredictors modal_predictors(const scenarios::Scenario& scenario, const Model& model, int n_modes,
                                               const Drive& typical) {
  const scenarios::MachineModel& machine = *scenario.machine;
  if (const scenarios::ReducedMachine* reduced = model.reduced()) {
    if (reduced->modal) return *reduced->modal;
    throw InputError(machine.where, fmt::format("thermostat '{}' switches; a linear model (thermal modes) cannot follow it. "
                                                "`simulate` can",
                                                reduced->system.thermostats.front().name));
  }
  return compensation::make_modal_predictors(model.full()->system, n_modes, scenarios::start_state(machine, *model.full()),
                                             scenarios::felt_ambient_at_start_K(machine), typical);
}

scenarios::Machine build_machine(const scenarios::MachineModel& model, const Listener& listener, int n_fields,
                                 const mesh::Mesh* drawn, const solver::Ranks* ranks) {
  listener.begin("meshing");
  scenarios::PlacedMachine placed = drawn ? scenarios::place(model, *drawn) : scenarios::place(model);
  const bool is_elastic = scenarios::needs_elasticity(placed, n_fields > 0);
  listener.begin(is_elastic ? fmt::format("solving {} elastic unknowns", 3 * placed.mesh.n_nodes()) : "assembling");
  return scenarios::build(model, std::move(placed), is_elastic, n_fields, ranks);
}

scenarios::ReducedMachine open_reduced(const scenarios::MachineModel& model, const scenarios::ReductionPlan& plan,
                                       const Listener& listener, bool* was_known) {
  const std::string key = scenarios::machine_key(model, plan, build_name());
  const std::filesystem::path store = scenarios::machine_store();
  std::string damage;
  auto known = scenarios::load_machine(store, key, effects::heat_balance(model.effects), &damage);
  if (!damage.empty()) fmt::print(stderr, "note: a kept machine is damaged and made anew: {}\n", damage);
  if (was_known) *was_known = known.has_value();
  if (known) return std::move(*known);
  const scenarios::Machine machine = build_machine(model, listener, plan.with_fields ? kStates : 0);
  scenarios::require_ways_out(machine.placed.mesh, machine.placed.balance, model.where);
  listener.begin(fmt::format("reducing {} temperature unknowns", machine.system.size()));
  scenarios::ReducedMachine reduced = scenarios::reduce(model, machine, plan, listener);
  try {
    scenarios::save_machine(store, key, reduced);
  } catch (const InputError& e) {  // the run itself is not affected
    fmt::print(stderr, "note: the reduced model is not kept: {}\n", e.what());
  }
  return reduced;
}

Model open_model(const scenarios::Scenario& scenario, const std::vector<const Cyclogram*>& cyclograms,
                 const Listener& listener, bool with_fields, const mesh::Mesh* drawn, const solver::Ranks* ranks,
                 Follows follows) {
  const scenarios::MachineModel& model = *scenario.machine;
  effects::HeatBalance balance = effects::heat_balance(model.effects);
  if (scenario.solver.model == scenarios::ModelKind::kFull) {
    const int fields = with_fields ? n_fields(scenario) : 0;
    std::vector<const Cyclogram*> moving = cyclograms;
    if (moving.empty()) {
      for (const Cyclogram& c : scenario.cyclograms) moving.push_back(&c);
    }
    std::erase_if(moving, [&](const Cyclogram* c) { return !moves_axes(model.axes, *c); });
    if (moving.empty()) return {build_machine(model, listener, fields, drawn, ranks), std::move(balance), false};
    const mesh::Mesh own = drawn ? mesh::Mesh{} : build_mesh(model.mesh);
    if (!drawn) drawn = &own;
    Model opened{build_machine(model, listener, fields, drawn), std::move(balance), false};
    opened.poses = posed_machines(model, moving, *drawn, listener, with_fields);
    return opened;
  }
  const auto moves = [&](const Cyclogram* c) { return moves_axes(model.axes, *c); };
  const bool is_moved = follows == Follows::kMoves && std::any_of(cyclograms.begin(), cyclograms.end(), moves);
  if (is_moved) {
    require_no_thermostat(model, balance);
  } else {
    for (const Cyclogram* c : cyclograms) require_resting(model.axes, *c);
  }
  std::vector<const Cyclogram*> asked = cyclograms;
  for (const Cyclogram& c : scenario.cyclograms) asked.push_back(&c);
  ReductionPlan plan = reduction_plan(scenario, asked);
  if (is_moved) plan.moves = moved_axes(model.axes, asked);
  bool was_known = false;
  scenarios::ReducedMachine reduced = open_reduced(model, plan, listener, &was_known);
  Model opened{std::move(reduced), std::move(balance), was_known};
  if (is_moved)
    opened.reduced_poses = at_poses(model, *opened.reduced(), further_poses(model.axes, cyclograms), with_fields, listener);
  return opened;
}

}  // namespace driftwright::scenarios
