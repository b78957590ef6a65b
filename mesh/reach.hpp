#pragma once
// Which points of a machine's outside a hand can reach: not the sides of joints, bores and the inside of hollow castings.

#include "mesh/machine_skin.hpp"

namespace driftwright::mesh {

/// Of each node of the mesh: whether it lies on the skin and is seen, straight and no flatter than about 15 degrees, from one of 26 directions. Nothing
/// is seen through the floor, a plate as large as the machine at its lowest point (z is up). Seen by depth buffers of 700 pixels across the machine:
/// gaps narrower than a pixel or two are closed.
[[nodiscard]] std::vector<bool> reachable_nodes(const Mesh& mesh, const MachineSkin& skin);

}  // namespace driftwright::mesh
