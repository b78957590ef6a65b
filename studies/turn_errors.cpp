#include "studies/turn_errors.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/dense.hpp"

namespace driftwright::studies {
namespace {

constexpr double kNoPivot = 1e-9;  // a direction that the positions do not tell apart: rounding

/// Two directions across an axis, of length 1.
std::pair<Eigen::Vector3d, Eigen::Vector3d> across_axis(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d first = direction.unitOrthogonal();
  return {first, direction.cross(first)};
}

/// Vectors one below the other.
Eigen::VectorXd stacked(const std::vector<Eigen::Vector3d>& vectors) {
  Eigen::VectorXd all(3 * static_cast<Eigen::Index>(vectors.size()));
  for (std::size_t i = 0; i < vectors.size(); ++i) all.segment<3>(3 * static_cast<Eigen::Index>(i)) = vectors[i];
  return all;
}

double longest_remainder(const Eigen::VectorXd& remainder) {
  double longest = 0.0;
  for (Eigen::Index i = 0; i < remainder.size(); i += 3) longest = std::max(longest, remainder.segment<3>(i).norm());
  return longest;
}

}  // namespace

std::optional<TurnFit> fit_turn(const Eigen::Vector3d& direction, const std::vector<double>& angles_rad,
                                const std::vector<Eigen::Vector3d>& values) {
  const auto [first, second] = across_axis(direction);
  Eigen::MatrixXd a(3 * static_cast<Eigen::Index>(angles_rad.size()), 5);
  for (std::size_t i = 0; i < angles_rad.size(); ++i) {
    const Eigen::Matrix3d turn = mesh::Way{.direction = direction, .turns = true}.by(angles_rad[i]).turn;
    a.middleRows<3>(3 * static_cast<Eigen::Index>(i)) << first, second, direction, turn * first, turn * second;
  }
  const dense::PivotedQr qr(a, kNoPivot);
  if (qr.rank() < a.cols()) return std::nullopt;
  const Eigen::VectorXd b = stacked(values), x = qr.solve(b);
  return TurnFit{.still = x[0] * first + x[1] * second + x[2] * direction,
                 .turning = x[3] * first + x[4] * second,
                 .left = longest_remainder(b - a * x)};
}

std::optional<RTestFit> fit_r_test(const Eigen::Vector3d& direction, const std::vector<Eigen::Vector3d>& arms_m,
                                   const std::vector<Eigen::Vector3d>& moved_m) {
  const auto [first, second] = across_axis(direction);
  Eigen::MatrixXd a(3 * static_cast<Eigen::Index>(arms_m.size()), 7);
  for (std::size_t i = 0; i < arms_m.size(); ++i) {
    const Eigen::Vector3d across_m = arms_m[i] - direction.dot(arms_m[i]) * direction;
    constexpr double kOnAxis_m = 1e-6;  // no ball is placed better
    if (across_m.norm() < kOnAxis_m) return std::nullopt;
    const Eigen::Vector3d outward = across_m.normalized();
    a.middleRows<3>(3 * static_cast<Eigen::Index>(i)) << first, second, first.cross(arms_m[i]), second.cross(arms_m[i]),
        outward, direction.cross(outward), direction;
  }
  const dense::PivotedQr qr(a, kNoPivot);
  if (qr.rank() < a.cols()) return std::nullopt;
  const Eigen::VectorXd b = stacked(moved_m), x = qr.solve(b);
  return RTestFit{.shift_m = x[0] * first + x[1] * second,
                  .tilt_rad = x[2] * first + x[3] * second,
                  .radial_m = x[4],
                  .tangential_m = x[5],
                  .axial_m = x[6],
                  .left_m = longest_remainder(b - a * x)};
}

CircleFit fit_circle(const std::vector<double>& angles_rad, const std::vector<double>& longer_m) {
  const auto n = static_cast<Eigen::Index>(angles_rad.size());
  const Eigen::Map<const Eigen::ArrayXd> angle_rad(angles_rad.data(), n);
  const Eigen::Map<const Eigen::VectorXd> longer(longer_m.data(), n);
  Eigen::MatrixXd a(n, 3);
  a << angle_rad.cos().matrix(), angle_rad.sin().matrix(), Eigen::VectorXd::Ones(n);
  const Eigen::VectorXd x = dense::least_squares(a, longer);
  const Eigen::VectorXd about_centre = longer - a.leftCols(2) * x.head(2);
  return {.centre_m = x.head<2>(),
          .radius_m = x[2],
          .circular_m = about_centre.maxCoeff() - about_centre.minCoeff(),
          .most_m = longer.maxCoeff(),
          .least_m = longer.minCoeff()};
}

Eigen::Vector3d error_on_axis(const std::vector<scenarios::MovingAxis>& axes, std::size_t axis, const std::string& work,
                              const VolumePoint& point, std::size_t time) {
  const std::vector<scenarios::MovingAxis> here = scenarios::axes_at(axes, point.pose);
  const Eigen::Vector3d tool_m = scenarios::motion_of(here, work)(point.place_m);
  const Eigen::Vector3d arm_m = scenarios::way_at_pose(here, axis).through_m - tool_m;
  return point.error_m[time] + point.turn_rad[time].cross(arm_m);
}

}  // namespace driftwright::studies
