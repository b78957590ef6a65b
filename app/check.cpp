#include <fmt/format.h>

#include "app/results.hpp"
#include "app/verbs.hpp"
#include "mesh/quality.hpp"

namespace driftwright::app {

void check(const CommonOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  if (!scenario.machine) {
    fmt::print("{}: fine; a study of measured records, target {}\n", options.scenario, scenario.study->target);
    return;
  }
  Progress progress;
  progress.begin("meshing");
  const scenarios::PlacedMachine placed = scenarios::place(*scenario.machine);
  const mesh::Quality quality = mesh::worst_quality(placed.mesh);
  progress.end();
  fmt::print(
      "{}: fine; {} nodes, {} cells in {} regions, {} joints, {} effects, {} sensors, {} cyclograms; worst "
      "scaled Jacobian {:.3f}\n",
      options.scenario, placed.mesh.n_nodes(), placed.mesh.cells.size(), placed.mesh.regions.size(),
      placed.mesh.joints.size(), scenario.machine->effects.size(), scenario.machine->sensors.size(),
      scenario.cyclograms.size(), quality.min_scaled);
  for (const std::string& note : placed.mesh.notes) fmt::print("note: {}\n", note);
}

}  // namespace driftwright::app
