#include "mesh/motion.hpp"

#include <Eigen/Geometry>

namespace driftwright::mesh {

Motion Way::by(double position_SI) const {
  if (!turns) return {.shift_m = position_SI * direction};
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(position_SI, direction).toRotationMatrix();
  return {.turn = turn, .shift_m = through_m - turn * through_m};
}

Eigen::Vector3d Way::along(const Eigen::Vector3d& point_m) const {
  if (!turns) return direction;
  constexpr double kOnAxis_m = 1e-9;
  const Eigen::Vector3d velocity = direction.cross(point_m - through_m);
  const double radius_m = velocity.norm();
  return radius_m > kOnAxis_m ? Eigen::Vector3d(velocity / radius_m) : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

Way Way::moved(const Motion& motion) const {
  return {.direction = motion.turn * direction, .turns = turns, .through_m = motion(through_m)};
}

}  // namespace driftwright::mesh
