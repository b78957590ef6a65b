#pragma once
// The edges and faces of each cell shape.

#include <Eigen/Core>
#include <array>
#include <span>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// Edges as pairs of corners, in VTK's order. In a quadratic shape the mid-side node of edge e has the index n_corners + e.
[[nodiscard]] std::span<const std::array<int, 2>> edges_of(CellShape shape);

/// A face of a cell: the facet that covers it.
struct Face {
  CellShape shape;
  std::array<int, 8> node;  ///< indices into the cell's nodes, n_nodes_of(shape) of them; counterclockwise from outside
};
/// Faces in the order of Abaqus and CalculiX: entry i is their face S(i+1). @throws std::logic_error  for a facet
[[nodiscard]] std::span<const Face> faces_of(CellShape cell);

/// Reference coordinates of the nodes. Tetrahedron, triangle: corners (0,0,0), (1,0,0), (0,1,0), (0,0,1). Hexahedron, quad:
/// the unit cube and square. Wedge: the triangle times [0, 1]. Mid-side nodes in the middle of their edges.
[[nodiscard]] std::span<const Eigen::Vector3d> reference_nodes(CellShape shape);

}  // namespace driftwright::mesh
