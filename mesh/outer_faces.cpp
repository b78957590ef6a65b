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
  const Face& of_shape = faces_of(cells.shape[face.cell])[face.face];
  const auto nodes = cells.nodes(face.cell);
  std::array<int, 4> corners{};
  const int n = n_corners_of(of_shape.shape);
  for (int i = 0; i < n; ++i) corners[i] = nodes[of_shape.node[i]];
  return face_key(std::span(corners).first(n));
}

FaceTable::FaceTable(const Cells& cells) {
  // In buckets by the second entry of the key (the lowest corner of a triangle), sorted within: much faster than a tree.
  std::vector<Entry> all;
  int n_nodes = 0;
  for (int node : cells.node) n_nodes = std::max(n_nodes, node + 1);
  std::vector<std::size_t> start(n_nodes + 1, 0);
  for (int c = 0; c < cells.size(); ++c) {
    const int n = static_cast<int>(faces_of(cells.shape[c]).size());
    for (int f = 0; f < n; ++f) {
      all.push_back({face_key(cells, {c, f}), {c, f}});
      ++start[all.back().key[1] + 1];
    }
  }
  for (int i = 0; i < n_nodes; ++i) start[i + 1] += start[i];
  entries_.resize(all.size());
  std::vector<std::size_t> fill(start.begin(), start.end() - 1);
  for (const Entry& e : all) entries_[fill[e.key[1]]++] = e;
  const auto before = [](const Entry& a, const Entry& b) {
    return a.key != b.key ? a.key < b.key : std::pair(a.at.cell, a.at.face) < std::pair(b.at.cell, b.at.face);
  };
#pragma omp parallel for schedule(dynamic, 512)
  for (int i = 0; i < n_nodes; ++i) {
    std::sort(entries_.begin() + static_cast<std::ptrdiff_t>(start[i]),
              entries_.begin() + static_cast<std::ptrdiff_t>(start[i + 1]), before);
  }
  start_ = std::move(start);
}

const CellFace* FaceTable::find(const FaceKey& key) const {
  if (key[1] < 0 || key[1] + 1 >= static_cast<int>(start_.size())) return nullptr;
  const auto begin = entries_.begin() + static_cast<std::ptrdiff_t>(start_[key[1]]);
  const auto end = entries_.begin() + static_cast<std::ptrdiff_t>(start_[key[1] + 1]);
  const auto hit = std::lower_bound(begin, end, key, [](const Entry& e, const FaceKey& k) { return e.key < k; });
  return hit == end || hit->key != key ? nullptr : &hit->at;
}

}  // namespace driftwright::mesh
