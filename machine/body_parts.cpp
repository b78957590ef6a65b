#include "machine/body_parts.hpp"

#include <algorithm>
#include <stdexcept>

#include "solver/thermal_load.hpp"

namespace driftwright::scenarios {
namespace {

using Part = solver::BodyPart<solver::SparseRow>;

/// M and K0 of one region: those of a machine in which no other region stores or conducts heat.
void set_matrices(Part& part, const mesh::Mesh& mesh, solver::RegionMaterials materials, int region,
                  const effects::HeatBalance& nodes) {
  for (std::size_t r = 0; r < materials.size(); ++r) {
    if (static_cast<int>(r) == region) continue;
    materials[r].conductivity_W_mK = 0.0;
    materials[r].heat_capacity_J_kgK = 0.0;
  }
  solver::FullSystem alone = solver::assemble_heat(mesh, materials, nodes);
  part.conduction = std::move(alone.conduction);
  part.mass = std::move(alone.mass);
}

}  // namespace

std::vector<Part> body_parts(const MachineModel& model, const Machine& machine, const solver::RegionMaterials& materials,
                             const effects::HeatBalance& balance) {
  const mesh::Mesh& mesh = machine.placed.mesh;
  const Eigen::Index n = machine.system.size(), n_outputs = machine.system.outputs.state.cols();
  const auto n_sensors = static_cast<Eigen::Index>(model.sensors.size());
  effects::HeatBalance nodes;  // alone, and without capacity
  nodes.nodes = balance.nodes;
  for (effects::LumpedNode& node : nodes.nodes) node.capacity_J_K = 0.0;

  std::vector<Part> parts;
  for (int r = 0; r < static_cast<int>(mesh.regions.size()); ++r) {
    parts.push_back({mesh.regions[static_cast<std::size_t>(r)], {}, {}, Eigen::MatrixXd::Zero(n, n_outputs)});
    set_matrices(parts.back(), mesh, materials, r, nodes);
  }
  for (std::size_t i = 0; i < balance.nodes.size(); ++i) {
    effects::HeatBalance one = nodes;
    one.nodes[i].capacity_J_K = balance.nodes[i].capacity_J_K;
    parts.push_back({balance.nodes[i].name, {}, {}, Eigen::MatrixXd::Zero(n, n_outputs)});
    set_matrices(parts.back(), mesh, materials, -1, one);
  }

  std::vector<solver::ThermalLoad> loads;  // of each region's expansion alone
  for (std::size_t r = 0; !machine.responses.empty() && r < mesh.regions.size(); ++r) {
    solver::RegionMaterials expanding = machine.placed.materials;
    for (std::size_t other = 0; other < expanding.size(); ++other) {
      if (other != r) expanding[other].expansion_1_K = 0.0;
    }
    loads.emplace_back(mesh, expanding);
  }
  const std::vector<effects::MaterialFactor> factors = effects::material_factors(model.effects);
  for (std::size_t f = 0; f < machine.placed.functionals.size(); ++f) {
    const auto output = n_sensors + static_cast<Eigen::Index>(f);
    const DisplacementOutput* displacement = f < model.displacements.size() ? &model.displacements[f] : nullptr;
    if (displacement && displacement->by_sensitivity) {
      for (const auto& [body, sensitivity_m_K] : displacement->by_sensitivity->terms) {
        auto part = std::find_if(parts.begin(), parts.end(), [&](const Part& p) { return p.body == body.name; });
        if (part == parts.end()) {  // a surface
          parts.push_back({body.name, {}, {}, Eigen::MatrixXd::Zero(n, n_outputs)});
          set_matrices(parts.back(), mesh, materials, -1, nodes);
          part = parts.end() - 1;
        }
        part->outputs.col(output) += effects::sensitivity_factor(factors, body, displacement->name) * sensitivity_m_K *
                                     solver::mean_weights(mesh, balance, body);
      }
    }
    if (displacement && !displacement->points) continue;
    if (machine.responses.empty()) throw std::logic_error("body_parts: displacements of a mesh require its elasticity");
    for (std::size_t r = 0; r < loads.size(); ++r) {
      parts[r].outputs.col(output).head(mesh.n_nodes()) += loads[r].transposed(machine.responses[f]);
    }
  }
  return parts;
}

}  // namespace driftwright::scenarios
