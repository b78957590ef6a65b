#pragma once
// Assembles the elastic stiffness K = ∫ B'D B dV + springs, in blocks of three unknowns per node.
// Source of the formulas: Zienkiewicz, Taylor & Zhu, The Finite Element Method, vol. 1, ch. 2 and 6.

#include "mesh/mesh.hpp"
#include "solver/heat_assembly.hpp"
#include "solver/node_matrix.hpp"
#include "solver/springs.hpp"

namespace driftwright::solver {

/// K over all nodes. Fixed unknowns have a row and a column of zeros, and one on the diagonal.
/// @param held  not 0 for each dof 3 node + direction that is fixed, and for nodes of no cell
[[nodiscard]] NodeMatrix assemble_stiffness(const mesh::Mesh& mesh, const RegionMaterials& materials,
                                            const std::vector<SpringLayer>& layers, const std::vector<char>& held);

/// The pairs of nodes that it couples.
[[nodiscard]] BlockPattern stiffness_pattern(const mesh::Mesh& mesh, const std::vector<SpringLayer>& layers);

}  // namespace driftwright::solver
