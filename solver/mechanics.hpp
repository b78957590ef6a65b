#pragma once
// The mechanical supports and joints of a machine, as the user gives them.

#include <Eigen/Core>
#include <array>
#include <string>
#include <variant>

namespace driftwright::solver {

/// A supported surface: fixed in directions, along its normal, or by springs to the ground; combinations are allowed.
struct Support {
  std::string surface;
  std::array<bool, 3> fixed = {true, true, true};  ///< displacement along x, y, z is zero
  /// Fixed along its normal and free to slide; for plane and curved surfaces.
  bool sliding = false;
  /// Stiffness of the whole surface along x, y, z [N/m], spread evenly over its area; 0: none.
  std::array<double, 3> springs_N_m = {0.0, 0.0, 0.0};
};

/// The sides have no slip and no gap.
struct Tied {};
/// The sides have no gap and no penetration, but are free to slip.
struct Sliding {};
/// The parts are in thermal contact only.
struct NoMechanics {};
/// Springs along and across the normal of each point. Values are for the whole joint: stiffness per area times the joint's
/// area.
struct NormalSprings {
  double normal_N_m = 0.0;
  double tangential_N_m = 0.0;  ///< in each direction of the tangent plane
};
/// A ring: force per relative displacement of its sides along an axis and in each direction across it. The stiffness is
/// spread evenly over the area, so that the ring also resists tilting, because of its width and diameter, and turning.
struct RingSprings {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< direction of length 1
  double axial_N_m = 0.0;
  double radial_N_m = 0.0;
};
using JointKind = std::variant<Tied, Sliding, NoMechanics, NormalSprings, RingSprings>;

/// How a joint connects its two sides. Joints that are not listed are tied.
struct JointMechanics {
  std::string joint;
  JointKind kind;
};

}  // namespace driftwright::solver
