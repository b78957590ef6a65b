#pragma once
// Supports and joints as layers of springs between points of surfaces, or between a surface and the ground.
//
// Force of one point on the jump s = Σ weight u(node):  S s, with the stiffness S = k A for springs, and for what shall not
// move 1000 E / l of the parts per area: under a stress σ a tied joint slips by σ l / (1000 E), l the size of a facet. That
// is a thousandth of what the layer of cells beside it gives way.

#include <Eigen/Core>
#include <vector>

#include "mesh/mesh.hpp"
#include "solver/heat_assembly.hpp"
#include "solver/mechanics.hpp"

namespace driftwright::solver {

struct SpringPoint {
  std::vector<int> node;
  std::vector<double> weight;     ///< side a positive, side b negative
  Eigen::Matrix3d stiffness_N_m;  ///< of this point, its area included
  Eigen::Vector3d position_m;
  int node_a = -1, node_b = -1;  ///< a node of each side; -1: the ground
  double area_m2 = 0.0;
  double normal_error = 0.0;  ///< of the normal in the stiffness [rad]; 0 where no normal enters
};
using SpringLayer = std::vector<SpringPoint>;

/// Springs of all joints that are not without mechanics, then of the supports that slide or have springs.
/// @throws InputError  for unknown joints (it lists those there are), a joint spoken of twice, and surfaces of a joint that
///                     lie further apart than the size of a facet
[[nodiscard]] std::vector<SpringLayer> spring_layers(const mesh::Mesh& mesh, const RegionMaterials& materials,
                                                     const std::vector<Support>& supports,
                                                     const std::vector<JointMechanics>& joints);

}  // namespace driftwright::solver
