#pragma once
// Mesh files as their tests read and measure them.

#include <algorithm>
#include <string>

#include "mesh/imported_mesh.hpp"
#include "mesh/quality.hpp"
#include "mesh/topology.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::mesh {

inline std::string path_of(const std::string& name) {
  return (temporary_folder() / name).string();
}

inline ImportedMesh recipe(const std::string& path, double unit_m) {
  ImportedMesh r;
  r.path = path;
  r.unit_m = unit_m;
  return r;
}

inline double volume(const Mesh& m, const std::string& region) {
  return volume_m3(m, m.region(region));
}
inline double area(const Mesh& m, const std::string& surface) {
  return area_m2(m, m.surface(surface));
}

/// Largest distance of a mid-side node from the middle of its edge, in a mesh whose edges should be straight.
inline double largest_bow_m(const Mesh& m) {
  double largest = 0.0;
  for (int c = 0; c < m.cells.size(); ++c) {
    if (!is_quadratic(m.cells.shape[c])) continue;
    const auto nodes = m.cells.nodes(c);
    int middle = n_corners_of(m.cells.shape[c]);
    for (const auto& [a, b] : edges_of(m.cells.shape[c])) {
      largest = std::max(largest,
                         (m.coords.col(nodes[middle++]) - 0.5 * (m.coords.col(nodes[a]) + m.coords.col(nodes[b]))).norm());
    }
  }
  return largest;
}

}  // namespace driftwright::mesh
