#pragma once
// Is this mesh fit to compute on?

#include <vector>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// Scaled Jacobian of each cell [-]: sqrt(2) times the smallest det(dx/dxi) over its nodes, divided by the largest
/// product of the three edge lengths at a corner. 1 for the regular tetrahedron, <= 0 for an inverted cell.
[[nodiscard]] std::vector<double> scaled_jacobians(const Mesh& mesh);

struct Quality {
  double min_det_m3 = 0.0;  ///< smallest Jacobian determinant at any node of any cell
  double min_scaled = 0.0;  ///< smallest scaled Jacobian
  double mean_scaled = 0.0;
  int worst_cell = -1;
};
[[nodiscard]] Quality worst_quality(const Mesh& mesh);

/// Volume of a region [m^3], area of a surface [m^2]; by index.
[[nodiscard]] double volume_m3(const Mesh& mesh, int region);
[[nodiscard]] double area_m2(const Mesh& mesh, int surface);

}  // namespace driftwright::mesh
