#include "machine/runnable.hpp"

#include <string_view>

#include "machine/ways_out.hpp"
#include "solver/rigid_motion.hpp"

namespace driftwright::scenarios {

InputError located(const MachineModel& model, const InputError& e) {
  const bool about_supports = std::string_view(e.what()).starts_with("supports") && !model.supports.empty();
  return {about_supports ? model.supports.front().where : model.where, e.what()};
}

void require_runnable(const Scenario& scenario, const PlacedMachine& placed) {
  const MachineModel& model = *scenario.machine;
  if (needs_elasticity(placed, scenario.solver.fields_format != FieldsFormat::kNone)) {
    try {
      (void)solver::holding(placed.mesh, placed.materials, placed.supports, placed.joints);
    } catch (const InputError& e) {
      throw located(model, e);
    }
  }
  const bool wants_ways_out =
      scenario.solver.model == ModelKind::kReduced || model.start == Start::kSteady || scenario.study;
  if (wants_ways_out) require_ways_out(placed.mesh, placed.balance, model.where);
  if (const auto& v = scenario.volume) (void)tool_against_work(model, placed.mesh, v->tool, v->work, v->where);
}

}  // namespace driftwright::scenarios
