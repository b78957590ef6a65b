#include "mesh/topology.hpp"

#include <vector>

namespace driftwright::mesh {

std::span<const Eigen::Vector3d> reference_nodes(CellShape shape) {
  static const std::vector<Eigen::Vector3d> triangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {.5, 0, 0}, {.5, .5, 0}, {0, .5, 0}};
  static const std::vector<Eigen::Vector3d> tetrahedron = {{0, 0, 0}, {1, 0, 0},    {0, 1, 0},   {0, 0, 1},   {.5, 0, 0},
                                                           {.5, .5, 0}, {0, .5, 0}, {0, 0, .5}, {.5, 0, .5}, {0, .5, .5}};
  const bool facet = shape == CellShape::kTri3 || shape == CellShape::kTri6;
  return std::span<const Eigen::Vector3d>(facet ? triangle : tetrahedron).first(n_nodes_of(shape));
}

}  // namespace driftwright::mesh
