#pragma once
// The faces of cells: which lie outside, and which facet of a surface belongs to which.

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "mesh/topology.hpp"

namespace driftwright::mesh {

/// Corner nodes of a face in increasing order, -1 first where there are three: the same for the two cells that share it.
using FaceKey = std::array<int, 4>;
[[nodiscard]] FaceKey face_key(std::span<const int> corners);

/// A face of a cell.
struct CellFace {
  int cell = -1;
  int face = -1;  ///< index into faces_of()
};
/// Nodes of the facet that covers it, and its corners' key.
[[nodiscard]] std::vector<int> nodes_of(const Cells& cells, CellFace face);
[[nodiscard]] FaceKey face_key(const Cells& cells, CellFace face);
[[nodiscard]] CellShape shape_of(const Cells& cells, CellFace face);

/// Every face with the cells at it, one outside and two inside a body. A third would be an overlap: it is kept, too.
[[nodiscard]] std::map<FaceKey, std::vector<CellFace>> all_faces(const Cells& cells);

}  // namespace driftwright::mesh
