#pragma once
// The faces of cells: which lie outside, and which facet of a surface belongs to which.

#include <array>
#include <span>
#include <vector>

#include "mesh/topology.hpp"

namespace driftwright::mesh {

/// Of the mesh's size: how far from a plane or cylinder a face may lie that is picked by it.
inline constexpr double kPickTolerance = 1e-4;

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
/// In the order of key[1], then of the keys; the cells of a face by their numbers.
class FaceTable {
 public:
  struct Entry {
    FaceKey key;
    CellFace at;
  };
  explicit FaceTable(const Cells& cells);
  /// Calls visit(key, cells' faces) for each face.
  template <class Visit>
  void for_each(Visit visit) const {
    for (std::size_t i = 0; i < entries_.size();) {
      const std::size_t begin = i;
      while (i < entries_.size() && entries_[i].key == entries_[begin].key) ++i;
      visit(entries_[begin].key, std::span<const Entry>(&entries_[begin], i - begin));
    }
  }
  /// The first cell's face of a key; nullptr where there is none.
  [[nodiscard]] const CellFace* find(const FaceKey& key) const;

 private:
  std::vector<Entry> entries_;
  std::vector<std::size_t> start_;  ///< of the entries whose key[1] is a node
};

}  // namespace driftwright::mesh
