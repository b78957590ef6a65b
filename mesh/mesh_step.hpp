#pragma once
// STEP drawings, meshed by Gmsh's OpenCASCADE kernel.

#include "mesh/imported_mesh.hpp"

namespace driftwright::mesh {

/// Each solid is a part with its own nodes; solids of one region name are one part. Where parts touch there is a joint, named as
/// mesh_parts() does. Outer faces lie on no surface yet. Region names: of the points given, else the last part of the label
/// that the file gives the solid. Lengths are converted from the unit in the file.
/// @throws InputError  for a file that cannot be read, without solids, a solid without a name, a point in no solid
/// @throws SolveError  when Gmsh cannot mesh it
[[nodiscard]] Mesh mesh_step(const ImportedMesh& recipe);

}  // namespace driftwright::mesh
