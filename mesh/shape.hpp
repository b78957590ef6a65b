#pragma once
// Shape functions and quadrature of the cells and facets.

#include <Eigen/Core>
#include <span>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// Values and derivatives of the shape functions at one reference point (reference cells: reference_nodes() in
/// mesh/topology.hpp). Columns past n are unused. Triangles and tetrahedra: complete polynomials; quads, hexahedra and
/// wedges: bilinear and trilinear, and the serendipity functions of 8, 20 and 15 nodes (Zienkiewicz & Taylor, The Finite
/// Element Method, vol. 1, ch. 8).
struct ShapeValues {
  int n = 0;
  Eigen::Matrix<double, 1, kMaxNodesPerCell> N;
  Eigen::Matrix<double, 3, kMaxNodesPerCell> dN;  ///< d N / d xi; row 2 is zero for facets
};
[[nodiscard]] ShapeValues shape_values(CellShape shape, const Eigen::Vector3d& xi);

struct QuadraturePoint {
  Eigen::Vector3d xi;
  double weight;  ///< the weights of a rule sum to the reference volume (tet 1/6, wedge 1/2, hex 1) or area (1/2, 1)
};
/// A rule that integrates polynomials up to `degree` >= 0 exactly on the reference cell: the total degree for triangles and
/// tetrahedra (at most 5), the degree in each direction for quads and hexahedra (at most 7), the total degree in the
/// triangle and the degree along the axis for wedges (at most 5). Sources: Keast 1986 (tetrahedron, 4 and 15 points),
/// Dunavant 1985 (triangle, 3 and 7 points), Gauss-Legendre.
/// @throws std::logic_error  for a degree above those
[[nodiscard]] std::span<const QuadraturePoint> quadrature(CellShape shape, int degree);

/// The rule for ∫ N N' and ∫ N: exact on every cell with straight edges; on facets if they are plane.
[[nodiscard]] std::span<const QuadraturePoint> mass_rule(CellShape shape);
/// The rule for ∫ ∇N ∇N': full integration, exact on affine cells. Tetrahedra have 1 and 4 points, hexahedra 8 and 27,
/// wedges 6 and 21. @throws std::logic_error for a facet
[[nodiscard]] std::span<const QuadraturePoint> stiffness_rule(CellShape shape);

/// Coordinates of a cell's nodes, 3 x n, in the order of the cell.
[[nodiscard]] Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMaxNodesPerCell> cell_coords(const Mesh& mesh,
                                                                                           std::span<const int> nodes);

/// Jacobian dx/dxi (column j: dx/dxi_j) and its determinant; for a facet the determinant is the ratio of areas.
struct Jacobian {
  Eigen::Matrix3d dx_dxi = Eigen::Matrix3d::Zero();
  double det = 0.0;
};
[[nodiscard]] Jacobian jacobian(const ShapeValues& s, const Eigen::Ref<const Eigen::Matrix3Xd>& coords, CellShape shape);

}  // namespace driftwright::mesh
