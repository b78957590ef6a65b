#pragma once
// Fits a circular cylinder to points.

#include <Eigen/Core>
#include <optional>

namespace driftwright::mesh {

struct FittedCylinder {
  Eigen::Vector3d through_m = Eigen::Vector3d::Zero();  ///< the point of the axis nearest to the mean of the points
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();      ///< unit length; its largest component is positive
  double radius_m = 0.0;
  double largest_error_m = 0.0;  ///< largest distance of a point from the cylinder
};

/// Least squares of the distances of points from the cylinder (Levenberg-Marquardt in position, direction and radius). It
/// starts from the directions that the normals avoid most, with the circle of Kåsa (IEEE Trans. Instrum. Meas. 25 (1976) 8)
/// across them.
/// @param points_m  3 x n on the cylinder, nearly; n >= 6
/// @param normals   3 x m of the surface, of any length, either way; for the start alone
/// @returns nothing for fewer points, or points on a line
[[nodiscard]] std::optional<FittedCylinder> fit_cylinder(const Eigen::Matrix3Xd& points_m, const Eigen::Matrix3Xd& normals);

}  // namespace driftwright::mesh
