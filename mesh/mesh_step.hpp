#pragma once
// Meshes STEP drawings with Gmsh's OpenCASCADE kernel.

#include <vector>

#include "mesh/imported_mesh.hpp"

namespace driftwright::mesh {

/// Each solid is a part with its own nodes; solids with the same region name are one part. There is a joint where parts
/// touch, with a name as in mesh_parts(). Outer faces belong to no surface yet. Region names come from the given points,
/// else from the last part of the solid's label in the file. Lengths are converted from the unit given in the file, or from
/// `unit_m` if set.
/// @param as_it_comes  for a drawing without a scenario: solids without a name are called solid_1, solid_2 ... in the file's
///                     order, and mesh sizes are suggested_mesh_sizes_m()
/// @throws InputError  for a file that cannot be read or has no solids, a solid without a name, a point outside all solids
/// @throws SolveError  when Gmsh cannot mesh it
[[nodiscard]] Mesh mesh_step(const ImportedMesh& recipe, bool as_it_comes = false);

/// Volume and surface of a part.
struct PartExtent {
  double volume_m3, area_m2;
};
/// First choice of mesh sizes [m] for the parts of one machine: two second-order cells along a cube's edge and one through a
/// plate, all coarser by a common factor if that would give more than 15 000 cells in total.
[[nodiscard]] std::vector<double> suggested_mesh_sizes_m(const std::vector<PartExtent>& parts);

}  // namespace driftwright::mesh
