#include <fmt/format.h>

#include "app/results.hpp"
#include "app/verbs.hpp"
#include "mesh/quality.hpp"
#include "output/vtk_fields.hpp"
#include "solver/joint.hpp"

namespace driftwright::app {

void mesh(const CommonOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  const scenarios::MachineModel& model = scenarios::require_machine(scenario, "mesh");
  if (std::holds_alternative<scenarios::LumpedMachine>(model.mesh))
    throw InputError(model.where, "a lumped machine has no mesh");
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress;
  progress.begin("meshing");
  const scenarios::PlacedMachine placed = scenarios::place(model);
  const mesh::Mesh& m = placed.mesh;
  output::write_mesh(m, mesh::scaled_jacobians(m), folder.path("mesh.vtu"));
  folder.commit();
  progress.end();

  const mesh::Quality quality = mesh::worst_quality(m);
  fmt::print("{} nodes, {} cells; scaled Jacobian: worst {:.4f} (cell {} in {}), mean {:.3f}\n", m.n_nodes(), m.cells.size(),
             quality.min_scaled, quality.worst_cell, m.regions[m.cells.group[quality.worst_cell]], quality.mean_scaled);
  for (std::size_t r = 0; r < m.regions.size(); ++r) {
    const int region = static_cast<int>(r);
    const double volume = mesh::volume_m3(m, region);
    fmt::print("  region  {:<32} {:8.3f} l  {:8.1f} kg  {:6} cells\n", m.regions[r], 1e3 * volume,
               volume * placed.materials[r].density_kg_m3, m.cells_in(region).size());
  }
  for (std::size_t s = 0; s < m.surfaces.size(); ++s) {
    if (m.surfaces[s].find('@') != std::string::npos) continue;
    fmt::print("  surface {:<32} {:8.4f} m2\n", m.surfaces[s], mesh::area_m2(m, static_cast<int>(s)));
  }
  for (const mesh::Joint& joint : m.joints) {
    double area_m2 = 0.0, gap_m = 0.0;
    for (const solver::JointPoint& p : solver::joint_points(m, joint)) {
      area_m2 += p.area_m2;
      gap_m = std::max(gap_m, p.gap_m);
    }
    fmt::print("  joint   {:<32} {:8.4f} m2 in contact, sides up to {:.3f} mm apart\n", joint.name, area_m2, 1e3 * gap_m);
  }
  for (const std::string& note : m.notes) fmt::print("note: {}\n", note);
  fmt::print("written to {}\n", shown_path(folder.target() / "mesh.vtu"));
}

}  // namespace driftwright::app
