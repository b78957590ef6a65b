#pragma once
// Names places that a mesh file does not name: outer faces by geometry, joints by pairs of surfaces.

#include "mesh/imported_mesh.hpp"

namespace driftwright::mesh {

/// Adds the surfaces in their order. A face may belong to several, except to those of RemainingPick.
/// Faces count as lying in a plane or on a cylinder within 1e-4 of the mesh's size.
/// @throws InputError  at the entry: for a name that exists already, a region that does not exist, a pick that finds nothing
void pick_surfaces(Mesh& mesh, const std::vector<SurfacePick>& picks);

/// Adds the joints; their sides are copies of the surfaces, named "<joint>@<surface>".
/// @throws InputError  at the entry: for an unknown surface, a name that exists already, sides that share nodes
void add_joints(Mesh& mesh, const std::vector<JointPick>& picks);

}  // namespace driftwright::mesh
