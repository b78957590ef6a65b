#pragma once
// Bodies may touch and must not overlap: what both fill would count twice.

#include <optional>
#include <vector>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// Two cells of different bodies (cells that share no node, directly or through others) of which one reaches into the other.
struct CellOverlap {
  int cell, other;
  Eigen::Vector3d point_m;  ///< in both
};

/// The first overlap, by the number of the cell that reaches in; none where bodies only touch.
///
/// A cell reaches in where its centre, or a point halfway from there to a corner, lies in a cell of another body. Facets of
/// curved faces that touch may so lie in each other by a quarter of a cell's thickness; more is an overlap.
///
/// @param together  a number for each region: bodies whose regions have the same one are not compared; empty: all are
[[nodiscard]] std::optional<CellOverlap> find_overlap(const Mesh& mesh, const std::vector<int>& together = {});

}  // namespace driftwright::mesh
