#pragma once
// Finds the cell or facet nearest to a point, for sensors, displacement points and joints that do not match.

#include <Eigen/Core>
#include <span>

#include "mesh/mesh.hpp"
#include "mesh/shape.hpp"

namespace driftwright::mesh {

/// A point of the mesh: weights N_i on the nodes of one cell or facet.
struct MeshPoint {
  int cell = -1;
  Eigen::Vector3d xi = Eigen::Vector3d::Zero();          ///< reference coordinates, inside the reference cell
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< where it really lies
  double distance_m = 0.0;                               ///< from the point asked for
};

/// The point of `candidates` (indices into `cells`) nearest to `point_m`. Exact for straight cells; for curved ones by
/// Gauss-Newton, which converges inside, on the surface and, where the distance is small against the radius, outside.
/// cell == -1 when candidates is empty.
[[nodiscard]] MeshPoint nearest_point(const Mesh& mesh, const Cells& cells, std::span<const int> candidates,
                                      const Eigen::Vector3d& point_m);

}  // namespace driftwright::mesh
