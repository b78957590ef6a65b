#pragma once
// Errors of a rotary axis and of a circle, fitted to displacements over the angle. All of them are small: rotations add.

#include <optional>
#include <vector>

#include "studies/posed_error.hpp"

namespace driftwright::studies {

/// Vectors over the positions p of an axis as still + R(p) turning, R(p) the turn about the axis: what rests in the machine,
/// and what turns with the body. Along the axis only `still` counts.
struct TurnFit {
  Eigen::Vector3d still, turning;
  double left = 0.0;  ///< length of the longest remainder
};
/// Least squares. @param direction  of the axis, length 1
/// @returns  nothing if all positions are the same, or full turns apart
[[nodiscard]] std::optional<TurnFit> fit_turn(const Eigen::Vector3d& direction, const std::vector<double>& angles_rad,
                                              const std::vector<Eigen::Vector3d>& values);

/// What an R-test tells of a rotary axis: D = shift + tilt x arm + radial u + tangential (n x u) + axial n, with the arm
/// from the axis' point to the ball, its part u across the axis (length 1) and the axis n.
struct RTestFit {
  Eigen::Vector3d shift_m;    ///< of the axis' point, across the axis: XOC, YOC of ISO 230-7 (XOB, ZOB; YOA, ZOA)
  Eigen::Vector3d tilt_rad;   ///< of the axis, across it: AOC, BOC
  double radial_m = 0.0;      ///< of the ball in the work, away from the axis: growth of the work
  double tangential_m = 0.0;  ///< of the ball in the work, along a positive turn
  double axial_m = 0.0;       ///< of the ball along the axis; that of the axis' point and of the work cannot be separated
  double left_m = 0.0;        ///< length of the longest remainder: error motions (EXC, ...), and errors of the linear axes
};
/// Least squares. @param arms_m   of each position @param moved_m  D: of the ball against the sensors
/// @returns  nothing if the ball is on the axis, or fewer than three positions differ
[[nodiscard]] std::optional<RTestFit> fit_r_test(const Eigen::Vector3d& direction,
                                                 const std::vector<Eigen::Vector3d>& arms_m,
                                                 const std::vector<Eigen::Vector3d>& moved_m);

/// The radial deviations of a circular test (ISO 230-4), with the least-squares circle.
struct CircleFit {
  Eigen::Vector2d centre_m;            ///< of the circle, along the two axes
  double radius_m = 0.0;               ///< of the circle less the commanded one
  double circular_m = 0.0;             ///< circular deviation G: width of the ring about its centre that contains the path
  double most_m = 0.0, least_m = 0.0;  ///< radial deviation F, highest and lowest, about the commanded centre
};
/// @param longer_m  actual - commanded radius at each angle, at least three of them different
[[nodiscard]] CircleFit fit_circle(const std::vector<double>& angles_rad, const std::vector<double>& longer_m);

/// The error at a point of a volume, carried by tool and work as rigid bodies to the point of a rotary axis that turns the
/// work: e + turn x (axis - tool). Along x, y, z.
[[nodiscard]] Eigen::Vector3d error_on_axis(const std::vector<scenarios::MovingAxis>& axes, std::size_t axis,
                                            const std::string& work, const VolumePoint& point, std::size_t time);

}  // namespace driftwright::studies
