#pragma once
// The outside of a mesh as triangles, for pictures.

#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// The machine's outside. Mid-side nodes are corners of triangles, too.
struct MachineSkin {
  std::vector<std::array<int, 3>> triangle;  ///< nodes, counterclockwise from outside
  std::vector<int> part;                     ///< of each triangle: the named surface, or behind these the region
  std::vector<int> surface;                  ///< of each triangle, -1: has no name
  std::vector<int> region;                   ///< of each triangle
};
/// In the order of the mesh's faces: the same mesh gives the same triangles.
[[nodiscard]] MachineSkin skin_of(const Mesh& mesh);

}  // namespace driftwright::mesh
