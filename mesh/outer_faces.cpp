#include "mesh/outer_faces.hpp"

#include <algorithm>

namespace driftwright::mesh {

FaceKey face_key(std::span<const int> corners) {
  FaceKey key = {-1, -1, -1, -1};
  std::copy(corners.begin(), corners.end(), key.begin());
  std::sort(key.begin(), key.end());
  return key;
}

std::vector<int> nodes_of(const Cells& cells, CellFace face) {
  const Face& of_shape = faces_of(cells.shape[face.cell])[face.face];
  const auto nodes = cells.nodes(face.cell);
  std::vector<int> list;
  for (int i = 0; i < n_nodes_of(of_shape.shape); ++i) list.push_back(nodes[of_shape.node[i]]);
  return list;
}

CellShape shape_of(const Cells& cells, CellFace face) {
  return faces_of(cells.shape[face.cell])[face.face].shape;
}

FaceKey face_key(const Cells& cells, CellFace face) {
  const std::vector<int> nodes = nodes_of(cells, face);
  return face_key(std::span(nodes).first(n_corners_of(shape_of(cells, face))));
}

std::map<FaceKey, std::vector<CellFace>> all_faces(const Cells& cells) {
  std::map<FaceKey, std::vector<CellFace>> faces;
  for (int c = 0; c < cells.size(); ++c) {
    const int n = static_cast<int>(faces_of(cells.shape[c]).size());
    for (int f = 0; f < n; ++f) faces[face_key(cells, {c, f})].push_back({c, f});
  }
  return faces;
}

}  // namespace driftwright::mesh
