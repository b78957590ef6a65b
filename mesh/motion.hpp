#pragma once
// How a body moves: the way on which it slides or turns, and where that has brought it.

#include <Eigen/Core>

namespace driftwright::mesh {

/// A rigid motion: a point as drawn goes to turn x point + shift.
struct Motion {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();

  [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector3d& point_m) const { return turn * point_m + shift_m; }
  /// Where a point that the motion has moved was before.
  [[nodiscard]] Eigen::Vector3d before(const Eigen::Vector3d& point_m) const {
    return turn.transpose() * (point_m - shift_m);
  }
  /// This motion after another one.
  [[nodiscard]] Motion after(const Motion& first) const {
    return {.turn = turn * first.turn, .shift_m = turn * first.shift_m + shift_m};
  }
  [[nodiscard]] bool operator==(const Motion& other) const { return turn == other.turn && shift_m == other.shift_m; }
};

/// A straight way, or a turn about an axis.
struct Way {
  Eigen::Vector3d direction;  ///< length 1: of sliding, or of the axis (right-handed)
  bool turns = false;
  Eigen::Vector3d through_m = Eigen::Vector3d::Zero();  ///< a point of the axis of a turn

  /// The motion by a position [m], or of a turn [rad]; 0 moves nothing, to the last bit.
  [[nodiscard]] Motion by(double position_SI) const;
  /// The direction in which a point moves, of length 1; zero on the axis of a turn.
  [[nodiscard]] Eigen::Vector3d along(const Eigen::Vector3d& point_m) const;
  /// The way of a body on another one that has moved.
  [[nodiscard]] Way moved(const Motion& motion) const;
};

}  // namespace driftwright::mesh
