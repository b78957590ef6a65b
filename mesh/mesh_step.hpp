#pragma once
// STEP drawings, meshed by Gmsh's OpenCASCADE kernel.

#include <vector>

#include "mesh/imported_mesh.hpp"

namespace driftwright::mesh {

/// Each solid is a part with its own nodes; solids of one region name are one part. Where parts touch there is a joint, named as
/// mesh_parts() does. Outer faces lie on no surface yet. Region names: of the points given, else the last part of the label
/// that the file gives the solid. Lengths are converted from the unit that the file says,
/// or from `unit_m` where that is given.
/// @param as_it_comes  of a drawing that no scenario describes yet: solids without a name are solid_1, solid_2 ... in the file's order, and mesh
///                     sizes are suggested_mesh_sizes_m()
/// @throws InputError  for a file that cannot be read, without solids, a solid without a name, a point in no solid
/// @throws SolveError  when Gmsh cannot mesh it
[[nodiscard]] Mesh mesh_step(const ImportedMesh& recipe, bool as_it_comes = false);

/// Volume and surface of a part.
struct PartExtent {
  double volume_m3, area_m2;
};
/// Mesh sizes to begin with [m], of parts of one machine: two cells of order 2 along a cube's edge and one through a plate, coarser by a common
/// factor where that would make more than 15 000 cells in all.
[[nodiscard]] std::vector<double> suggested_mesh_sizes_m(const std::vector<PartExtent>& parts);

}  // namespace driftwright::mesh
