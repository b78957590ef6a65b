#pragma once
// What holds a machine and its parts mechanically, as the user says it.

#include <array>
#include <string>
#include <variant>

namespace driftwright::solver {

/// A surface that is held: in directions, along its normal, or by springs to the ground; any of them together.
struct Support {
  std::string surface;
  std::array<bool, 3> fixed = {true, true, true};  ///< displacement along x, y, z is zero
  /// Held along its normal and free along itself; on plane and curved surfaces.
  bool sliding = false;
  /// Stiffness of the whole surface along x, y, z [N/m], spread evenly over its area; 0: none.
  std::array<double, 3> springs_N_m = {0.0, 0.0, 0.0};
};

/// No slip and no gap.
struct Tied {};
/// No gap and no penetration; free to slip.
struct Sliding {};
/// Parts that touch thermally alone.
struct NoMechanics {};
/// Springs along and across the normal of each point; total over the joint: stiffness per area times the joint's area.
struct NormalSprings {
  double normal_N_m = 0.0;
  double tangential_N_m = 0.0;  ///< in each direction of the tangent plane
};
/// A ring: force per displacement of one side against the other along an axis and in each direction across it. Spread
/// evenly over the area, so that the ring also resists tilting, by its width and diameter, and turning.
struct RingSprings {
  int axis = 0;  ///< 0, 1, 2 = x, y, z
  double axial_N_m = 0.0;
  double radial_N_m = 0.0;
};
using JointKind = std::variant<Tied, Sliding, NoMechanics, NormalSprings, RingSprings>;

/// How a joint holds its two sides together. Joints that are not spoken of are tied.
struct JointMechanics {
  std::string joint;
  JointKind kind;
};

}  // namespace driftwright::solver
