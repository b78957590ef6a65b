#pragma once
// Three meshes of one machine for a study of convergence: the scenario's own, and coarser or finer ones.

#include <array>

#include "base/listener.hpp"
#include "scenarios/reader/read_mesh.hpp"

namespace driftwright::studies {

/// Least ratio of the element sizes of two successive meshes; a smaller one drowns the change in the scatter of the mesher
/// (Celik et al., J. Fluids Eng. 130 (2008) 078001).
inline constexpr double kLeastSizeRatio = 1.3;

struct MeshRung {
  scenarios::MeshRecipe recipe;
  double factor = 1.0;  ///< on every mesh size of the scenario
  double size_m = 0.0;  ///< cube root of volume over number of elements: thin walls keep elements that the factor would save
  int n_elements = 0;
};

struct MeshLadder {
  std::array<MeshRung, 3> rungs;  ///< from coarse to fine
  std::size_t own = 0;            ///< index of the scenario's own mesh
};

/// Meshes the machine until three sizes follow each other by kLeastSizeRatio or more. One mesh is finer than the scenario's
/// if it has at most `most_elements`, the others are coarser; where coarser ones do not exist (each wall has one element
/// already), finer ones replace them.
/// @throws InputError  for a machine without mesh sizes, and if `most_elements` leaves fewer than three meshes
/// @throws SolveError  when Gmsh fails on the scenario's own mesh
[[nodiscard]] MeshLadder mesh_ladder(const scenarios::MeshRecipe& own, int most_elements, const Listener& listener);

/// Order of the machine's elements, 1 or 2; 0 for a machine without elements.
[[nodiscard]] int element_order(const scenarios::MeshRecipe& recipe);

}  // namespace driftwright::studies
