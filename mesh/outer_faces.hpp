#pragma once
// The faces of cells: which are outside, and which facet of a surface belongs to which face.

#include <array>
#include <span>
#include <vector>

#include "mesh/topology.hpp"

namespace driftwright::mesh {

/// Largest distance of a picked face from the plane or cylinder, as a share of the mesh's size.
inline constexpr double kPickTolerance = 1e-4;

/// Corner nodes of a face in increasing order, with -1 first if there are three: equal for the two cells that share the
/// face.
using FaceKey = std::array<int, 4>;
[[nodiscard]] FaceKey face_key(std::span<const int> corners);

/// A face of a cell.
struct CellFace {
  int cell = -1;
  int face = -1;  ///< index into faces_of()
};
/// The nodes of the facet that covers the face, the key of its corners, and its shape.
[[nodiscard]] std::vector<int> nodes_of(const Cells& cells, CellFace face);
[[nodiscard]] FaceKey face_key(const Cells& cells, CellFace face);
[[nodiscard]] CellShape shape_of(const Cells& cells, CellFace face);

/// Every face with its cells: one cell for an outer face, two for an inner face. A third would be an overlap; it is kept,
/// too. Sorted by key[1], then by the keys; the cells of a face by their numbers.
class FaceTable {
 public:
  struct Entry {
    FaceKey key;
    CellFace at;
  };
  explicit FaceTable(const Cells& cells);
  /// Calls visit(key, entries of this key) for each face.
  template <class Visit>
  void for_each(Visit visit) const {
    for (std::size_t i = 0; i < entries_.size();) {
      const std::size_t begin = i;
      while (i < entries_.size() && entries_[i].key == entries_[begin].key) ++i;
      visit(entries_[begin].key, std::span<const Entry>(&entries_[begin], i - begin));
    }
  }
  /// The first cell's face of a key; nullptr if there is none.
  [[nodiscard]] const CellFace* find(const FaceKey& key) const;

 private:
  std::vector<Entry> entries_;
  std::vector<std::size_t> start_;  ///< for each node: index of the first entry whose key[1] is the node
};

}  // namespace driftwright::mesh
