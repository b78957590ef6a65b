#pragma once
// Shape functions and quadrature of the cells and facets.

#include <Eigen/Core>
#include <array>
#include <span>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

inline constexpr int kMaxNodesPerCell = 10;

/// Edges of a tetrahedron in VTK's order: mid-side node n_corners + e lies between these two corners. The first three are
/// the edges of a triangle.
inline constexpr std::array<std::array<int, 2>, 6> kTetrahedronEdges = {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/// Values and derivatives of the shape functions at one reference point. Columns past n are unused.
/// Reference tetrahedron: (0,0,0), (1,0,0), (0,1,0), (0,0,1); reference triangle: (0,0), (1,0), (0,1).
struct ShapeValues {
  int n = 0;
  Eigen::Matrix<double, 1, kMaxNodesPerCell> N;
  Eigen::Matrix<double, 3, kMaxNodesPerCell> dN;  ///< d N / d xi; row 2 is zero for facets
};
[[nodiscard]] ShapeValues shape_values(CellShape shape, const Eigen::Vector3d& xi);

struct QuadraturePoint {
  Eigen::Vector3d xi;
  double weight;  ///< the weights of a rule sum to the reference volume (1/6) or area (1/2)
};
/// A rule that integrates polynomials up to `degree` exactly on the reference cell; degree 1, 2 or 5.
/// Sources: Keast 1986 (tetrahedron, 4 and 15 points), Dunavant 1985 (triangle, 3 and 7 points).
[[nodiscard]] std::span<const QuadraturePoint> quadrature(CellShape shape, int degree);

/// The rule that integrates products of two shape functions on straight cells and facets.
[[nodiscard]] std::span<const QuadraturePoint> mass_rule(CellShape shape);
/// The rule that integrates products of two gradients of shape functions on straight cells.
[[nodiscard]] std::span<const QuadraturePoint> stiffness_rule(CellShape shape);

/// Coordinates of a cell's nodes, 3 x n, in the order of the cell.
[[nodiscard]] Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMaxNodesPerCell> cell_coords(const Mesh& mesh,
                                                                                           std::span<const int> nodes);

/// Jacobian dx/dxi (column j: dx/dxi_j) and its determinant; for a facet the determinant is the area ratio.
struct Jacobian {
  Eigen::Matrix3d dx_dxi = Eigen::Matrix3d::Zero();
  double det = 0.0;
};
[[nodiscard]] Jacobian jacobian(const ShapeValues& s, const Eigen::Ref<const Eigen::Matrix3Xd>& coords, CellShape shape);

}  // namespace driftwright::mesh
