#pragma once
// Finds the cell or facet nearest to a point, for sensors, displacement points and joints that do not match.

#include <Eigen/Core>
#include <span>

#include "mesh/mesh.hpp"
#include "mesh/shape.hpp"

namespace driftwright::mesh {

/// A point of the mesh, given by a cell or facet and reference coordinates in it.
struct MeshPoint {
  int cell = -1;
  Eigen::Vector3d xi = Eigen::Vector3d::Zero();          ///< reference coordinates, inside the reference cell
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< its position
  double distance_m = 0.0;                               ///< distance from the requested point
};

/// The point of `candidates` (indices into `cells`) nearest to `point_m`. Exact for triangles and tetrahedra with straight
/// edges. Otherwise by Gauss-Newton within the reference cell, with step halving so that the distance never grows, from the
/// nearest of a grid of samples and from the middle: exact inside; outside, where the distance is small against the radius
/// of curvature, to 1e-12 of the cell's size, farther away slower and, far outside a strongly bent cell, to a local minimum.
/// cell == -1 when candidates is empty.
[[nodiscard]] MeshPoint nearest_point(const Mesh& mesh, const Cells& cells, std::span<const int> candidates,
                                      const Eigen::Vector3d& point_m);

}  // namespace driftwright::mesh
