#pragma once
// Measures of mesh quality, which show whether a mesh is fit for computation.

#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// Scaled Jacobian of each cell [-]: 1 for the ideal cell, <= 0 for an inverted one.
/// Tetrahedra: sqrt(2) times the smallest det(dx/dxi) over the nodes, divided by the largest product of the three edge
/// lengths at a corner; 1 for the regular one. Hexahedra: the smallest, over nodes and quadrature points, of det(dx/dxi)
/// over the product of the lengths of its columns, which at a corner are the edges; 1 where all angles are right. Wedges:
/// the same with the two longest of the three edges in the triangle and a factor 2/sqrt(3); 1 for the right prism on a
/// regular triangle. For cells with straight edges these are the corner values of the Verdict library (Stimpson et al.,
/// SAND2007-1751).
[[nodiscard]] std::vector<double> scaled_jacobians(const Mesh& mesh);

/// The worst and mean values of a mesh.
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
/// Area of one facet [m^2], given by its nodes.
[[nodiscard]] double facet_area_m2(const Mesh& mesh, CellShape shape, std::span<const int> nodes);

}  // namespace driftwright::mesh
