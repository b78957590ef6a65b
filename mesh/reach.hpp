#pragma once
// The points on a machine's outside that a hand can reach: not the sides of joints, bores and the inside of hollow castings.

#include "mesh/machine_skin.hpp"

namespace driftwright::mesh {

/// For each node of the mesh: true if it lies on the skin and is visible from one of 26 directions, in a straight line at an
/// angle of more than about 15 degrees to the surface. The floor, a plate as large as the machine at its lowest point (z is
/// up), blocks the view. Visibility is computed by depth buffers with 700 pixels across the machine; gaps narrower than one
/// or two pixels count as closed.
[[nodiscard]] std::vector<bool> reachable_nodes(const Mesh& mesh, const MachineSkin& skin);

}  // namespace driftwright::mesh
