#pragma once
// Supports and joints as layers of springs between points of surfaces, or between a surface and the ground.
//
// The force of a point for a jump s = Σ weight u(node) is S s. The stiffness is S = k A for springs. For directions that
// must not move it is 1000 E / l of the parts per area: under a stress σ a tied joint slips by σ l / (1000 E), l the size of
// a facet. This is a thousandth of the compression of the neighbouring layer of cells.

#include <Eigen/Core>
#include <vector>

#include "mesh/mesh.hpp"
#include "solver/heat_assembly.hpp"
#include "solver/mechanics.hpp"

namespace driftwright::solver {

/// A spring at one point of a surface.
struct SpringPoint {
  std::vector<int> node;
  std::vector<double> weight;     ///< side a positive, side b negative
  Eigen::Matrix3d stiffness_N_m;  ///< of this point, including its area
  Eigen::Vector3d position_m;
  int node_a = -1, node_b = -1;  ///< a node of each side; -1: the ground
  double area_m2 = 0.0;
  double normal_error = 0.0;  ///< error of the normal that the stiffness uses [rad]; 0 without a normal
};
using SpringLayer = std::vector<SpringPoint>;

/// Springs of all joints except those without mechanics, then of the supports that slide or have springs.
/// @throws InputError  for unknown joints (it lists the existing ones), a joint that is listed twice, and surfaces of a
///                     joint that are farther apart than the size of a facet
[[nodiscard]] std::vector<SpringLayer> spring_layers(const mesh::Mesh& mesh, const RegionMaterials& materials,
                                                     const std::vector<Support>& supports,
                                                     const std::vector<JointMechanics>& joints);

}  // namespace driftwright::solver
