#pragma once
// Do supports and joints hold every part? A factorisation alone does not tell: rounding makes the pivot of a free motion
// positive as often as not. So the parts are taken as rigid bodies and the null space of what holds them is looked at.

#include <vector>

#include "mesh/mesh.hpp"
#include "solver/springs.hpp"

namespace driftwright::solver {

/// Looks whether nothing can move as a rigid body. Parts are sets of cells that share nodes. A curved surface that slides is
/// not counted on to hold what it holds only by the error of its normals (the turning of a cylinder).
/// @param fixed  true for dof 3 node + direction that is held
/// @throws InputError  that names the parts and their free motions in words: "translate along x, rotate about z through
///                     x = 0.0 mm, y = 120.0 mm"
void require_held(const mesh::Mesh& mesh, const std::vector<SpringLayer>& layers, const std::vector<bool>& fixed);

/// What holds a machine.
struct Holding {
  std::vector<bool> fixed;  ///< true for dof 3 node + direction that a support fixes
  std::vector<SpringLayer> layers;
};
/// Of supports and joints. @throws InputError  as spring_layers() and require_held(): nothing is solved for, so that a scenario can be checked by it
[[nodiscard]] Holding holding(const mesh::Mesh& mesh, const RegionMaterials& materials, const std::vector<Support>& supports,
                              const std::vector<JointMechanics>& joints);

}  // namespace driftwright::solver
