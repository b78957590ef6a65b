#pragma once
// Checks whether supports and joints hold every part. A factorisation alone does not show this: rounding makes the pivot of
// a free motion positive as often as not. So the parts are treated as rigid bodies, and the null space of their constraints
// is computed.

#include <vector>

#include "mesh/mesh.hpp"
#include "solver/springs.hpp"

namespace driftwright::solver {

/// Checks that nothing can move as a rigid body. Parts are sets of cells that share nodes. A sliding curved surface does
/// not count as holding a motion that it resists only through the error of its normals (the rotation of a cylinder).
/// @param fixed  true for each fixed dof 3 node + direction
/// @throws InputError  that names the parts and their free motions in words: "translate along x, rotate about z through
///                     x = 0.0 mm, y = 120.0 mm"
void require_held(const mesh::Mesh& mesh, const std::vector<SpringLayer>& layers, const std::vector<bool>& fixed);

/// The constraints of a machine.
struct Holding {
  std::vector<bool> fixed;  ///< true for dof 3 node + direction that a support fixes
  std::vector<SpringLayer> layers;
};
/// The constraints from supports and joints. @throws InputError as spring_layers() and require_held(): nothing is solved, so
/// it can check a scenario
[[nodiscard]] Holding holding(const mesh::Mesh& mesh, const RegionMaterials& materials, const std::vector<Support>& supports,
                              const std::vector<JointMechanics>& joints);

}  // namespace driftwright::solver
