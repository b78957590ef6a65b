#pragma once
// What a machine may be asked for: `limits` of a scenario. Infinite: no limit.

#include <array>
#include <limits>

namespace driftwright {

/// Limits of a correction and of its single changes, by size.
struct CorrectionLimits {
  double most_um = std::numeric_limits<double>::infinity();
  double most_step_um = std::numeric_limits<double>::infinity();
};

struct MachineLimits {
  double speed_rpm = std::numeric_limits<double>::infinity();  ///< of the spindle
  double feed_m_s = std::numeric_limits<double>::infinity();   ///< programmed, along the path; rapids are not limited
  /// Positions of a program, x, y, z, in its own coordinates.
  std::array<double, 3> low_m = {-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity()};
  std::array<double, 3> high_m = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                                  std::numeric_limits<double>::infinity()};
  CorrectionLimits correction = {};
};

}  // namespace driftwright
