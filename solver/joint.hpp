#pragma once
// Joints between parts that share no nodes: quadrature points of the finer side are matched with the nearest points of the
// other.

#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace driftwright::solver {

/// One quadrature point of a joint. The jump of a nodal field across it is Σ weight_a u(node_a) - Σ weight_b u(node_b).
struct JointPoint {
  std::vector<int> node_a, node_b;
  std::vector<double> weight_a,
      weight_b;          ///< shape functions; each sums to one, so that heat is conserved
  double area_m2 = 0.0;  ///< quadrature weight times area ratio
  double gap_m = 0.0;    ///< distance between the two points along the normal
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit length, either orientation; smoothed, see mesh/normals.hpp
  double normal_error = 0.0;                         ///< error of the normal [rad], see mesh/normals.hpp
};

/// The quadrature points of a joint where its sides face each other; the rule is exact for products of quadratic functions
/// on straight facets. Where one side overhangs the other there are no points; the edge of the overlap is accurate to half a
/// facet.
/// @throws InputError  if the sides face each other nowhere
[[nodiscard]] std::vector<JointPoint> joint_points(const mesh::Mesh& mesh, const mesh::Joint& joint);

}  // namespace driftwright::solver
