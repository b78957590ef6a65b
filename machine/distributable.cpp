#include "machine/distributable.hpp"

#include <fmt/format.h>

#include "effects/heat_balance.hpp"

namespace driftwright::scenarios {
namespace {

[[noreturn]] void refuse(const Where& where, const std::string& what) {
  throw InputError(where, fmt::format("--distributed: {}; without --distributed one process computes it", what));
}

}  // namespace

void require_distributable(const Scenario& scenario, const std::vector<const Cyclogram*>& cyclograms) {
  const MachineModel& model = *scenario.machine;
  if (std::holds_alternative<LumpedMachine>(model.mesh))
    refuse(model.where, "a machine of lumped nodes has no mesh to divide");
  if (scenario.solver.model == ModelKind::kReduced) {
    throw InputError(model.where,
                     "--distributed: `solver: {model: reduced}` is computed by one process; `model: full` is required");
  }
  for (const Cyclogram* c : cyclograms) {
    if (moves_axes(model.axes, *c)) refuse(model.where, fmt::format("cyclogram '{}' moves axes", c->name));
  }
  if (model.start == Start::kSteady) refuse(model.where, "`start: steady` is not computed by several processes");
  for (const effects::Effect& e : model.effects) {
    if (e.field) refuse(e.where, fmt::format("{} takes a film from a file", e.name()));
  }
  for (const effects::FixedTemperature& fixed : effects::heat_balance(model.effects).fixed)
    refuse(model.where, fmt::format("{} prescribes a temperature", fixed.name));
}

}  // namespace driftwright::scenarios
