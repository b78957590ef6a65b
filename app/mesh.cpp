#include "app/results.hpp"
#include "findings/scenario_document.hpp"
#include "mesh/quality.hpp"
#include "output/vtk_fields.hpp"

namespace driftwright::app {

void mesh(const CommonOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  const scenarios::MachineModel& model = scenarios::require_machine(scenario, "mesh");
  if (std::holds_alternative<scenarios::LumpedMachine>(model.mesh))
    throw InputError(model.where, "a lumped machine has no mesh");
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  progress.begin("meshing");
  const scenarios::PlacedMachine placed = scenarios::place(model);
  output::write_mesh(placed.mesh, mesh::scaled_jacobians(placed.mesh), folder.path("mesh.vtu"));
  finish(findings::mesh_document(scenario, placed, folder.made_by()), folder, progress, options);
}

}  // namespace driftwright::app
