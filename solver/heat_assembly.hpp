#pragma once
// Assembles the full thermal system from mesh, materials and heat balance. Unknowns: the mesh's nodes in their order, then
// the lumped nodes in the order of the balance.

#include "effects/heat_balance.hpp"
#include "mesh/mesh.hpp"
#include "solver/material.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// Material of each region, in the order of mesh.regions.
using RegionMaterials = std::vector<Material>;

/// Assembles M, K0, sources, exchanges and the rest of the balance; `outputs` stays empty. The mesh may be empty.
///
///     M_ij = ∫ ρ c N_i N_j dV (consistent),  K0_ij = ∫ k ∇N_i·∇N_j dV,  film G_ij = ∫ N_i N_j dA
///
/// ρ, c and k are those at the reference temperature; if they vary, the system also contains the difference.
/// Every name in the balance must exist in the mesh or among its nodes (the scenario reader checks this).
/// @param share  the mesh is the part of this process; null: the whole
/// @throws std::logic_error  for a name that does not exist
[[nodiscard]] FullSystem assemble_heat(const mesh::Mesh& mesh, const RegionMaterials& materials,
                                       const effects::HeatBalance& balance, double reference_K = 293.15,
                                       std::shared_ptr<const Share> share = nullptr);

/// Weights that give the mean temperature of a body from the unknowns; they sum to one (over all processes, with a share).
[[nodiscard]] Eigen::VectorXd mean_weights(const mesh::Mesh& mesh, const effects::HeatBalance& balance,
                                           const effects::Body& body, const Share* share = nullptr);

}  // namespace driftwright::solver
