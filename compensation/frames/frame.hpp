#pragma once
// The frames of a control: translation, rotation, scale and mirror, with composition.

#include <Eigen/Core>
#include <array>

namespace driftwright::compensation {

/// The parts of a frame as written on the control: CTRANS : CROT : CSCALE : CMIRROR.
struct FrameParts {
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();  ///< about X, then Y, then Z, all fixed
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  std::array<bool, 3> mirror = {false, false, false};
};

/// An affine map p -> linear p + shift, from program coordinates towards machine coordinates.
struct Frame {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();

  [[nodiscard]] Eigen::Vector3d map(const Eigen::Vector3d& point_m) const { return linear * point_m + shift_m; }
};

/// linear = Rz Ry Rx diag(scale) diag(mirror ? -1 : 1), shift unchanged.
/// @throws RangeError  for a scale that is not above 0, and for values that are not finite
[[nodiscard]] Frame frame_of(const FrameParts& parts);

/// The control's `outer : inner` (the source paper writes +): p -> outer(inner(p)). Associative, not commutative.
[[nodiscard]] Frame compose(const Frame& outer, const Frame& inner);

}  // namespace driftwright::compensation
