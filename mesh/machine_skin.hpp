#pragma once
// The outside of a mesh as triangles, for pictures.

#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// The triangles of the outside. Mid-side nodes are also corners of triangles.
struct MachineSkin {
  std::vector<std::array<int, 3>> triangle;  ///< nodes, counterclockwise from outside
  std::vector<int> part;     ///< of each triangle: index of its named surface, or number of surfaces + region
  std::vector<int> surface;  ///< of each triangle; -1: without a name
  std::vector<int> region;   ///< of each triangle
  std::vector<int> face;     ///< of each triangle: number of its outer face, in the order of FaceTable
};
/// In the order of the mesh's faces: the same mesh gives the same triangles.
/// @param before_others  surface whose faces have its name even where they belong to other surfaces, too; else the last has it
[[nodiscard]] MachineSkin skin_of(const Mesh& mesh, int before_others = -1);

}  // namespace driftwright::mesh
