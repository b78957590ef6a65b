#include "compensation/frames/frame.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "base/errors.hpp"

namespace driftwright::compensation {

Frame frame_of(const FrameParts& parts) {
  if (!parts.shift_m.allFinite() || !parts.rotation_rad.allFinite() || !parts.scale.allFinite())
    throw RangeError("a frame's shift, rotation and scale must be finite");
  Eigen::Vector3d scale = parts.scale;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(scale[axis] > 0.0))
      throw RangeError(fmt::format("a frame's scale along {} is {:g}; it must be above 0", "XYZ"[axis], scale[axis]));
    if (parts.mirror[axis]) scale[axis] = -scale[axis];
  }
  const auto about = [&](int axis) {
    return Eigen::AngleAxisd(parts.rotation_rad[axis], Eigen::Vector3d::Unit(axis)).toRotationMatrix();
  };
  return {.linear = about(2) * about(1) * about(0) * scale.asDiagonal(), .shift_m = parts.shift_m};
}

Frame compose(const Frame& outer, const Frame& inner) {
  return {.linear = outer.linear * inner.linear, .shift_m = outer.linear * inner.shift_m + outer.shift_m};
}

}  // namespace driftwright::compensation
