#pragma once
// Heat capacity and conduction matrices of the cells of a mesh, summed on all cores.

#include <vector>

#include "mesh/mesh.hpp"
#include "solver/sparse.hpp"

namespace driftwright::solver {

/// Properties of a region at the reference temperature.
struct HeatProperties {
  double capacity_J_m3K = 0.0, conductivity_W_mK = 0.0;
};

/// Adds each cell's ∫ ρc N_i N_j dV to `mass` and ∫ k ∇N_i·∇N_j dV to `conduction`. Each entry is summed in the order of the
/// cells, whatever the number of threads.
/// @param of_region   one per region of the mesh
/// @param mass, conduction  with the same pattern, which has an entry for each pair of nodes of each cell; the first n_nodes
///                          unknowns are those of the nodes
/// @throws std::logic_error  when an entry is missing
void add_cells(const mesh::Mesh& mesh, const std::vector<HeatProperties>& of_region, SparseRow& mass, SparseRow& conduction);

}  // namespace driftwright::solver
