#include "app/results.hpp"
#include "base/delimited_text.hpp"
#include "base/version.hpp"
#include "findings/scenario_document.hpp"
#include "machine/mesh_demand.hpp"
#include "machine/runnable.hpp"

namespace driftwright::app {

void check(const CommonOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  std::optional<scenarios::PlacedMachine> placed;
  std::optional<scenarios::MeshDemand> demand;
  Progress progress(options.quiet);
  progress.begin("meshing");
  if (scenario.machine) {
    placed = scenarios::place(*scenario.machine);
    scenarios::require_runnable(scenario, *placed);
    progress.begin("counting what it will take");
    demand = scenarios::mesh_demand(scenario, *placed, scenario.solver.model == scenarios::ModelKind::kFull);
    scenarios::require_room(scenario, *placed, *demand, scenarios::room_bytes());
  }
  progress.end();
  show(findings::scenario_document(scenario, placed ? &*placed : nullptr, demand ? &*demand : nullptr, {kVersion, clean_name(options.scenario)}), options);
}

}  // namespace driftwright::app
