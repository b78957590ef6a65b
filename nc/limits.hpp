#pragma once
// Limits of a machine's axes, for the planned motion (nc/planned_motion.hpp).

#include <array>

namespace driftwright {

struct NcLimits {
  std::array<double, 3> velocity_m_s = {0, 0, 0};       ///< of x, y, z, > 0
  std::array<double, 3> acceleration_m_s2 = {0, 0, 0};  ///< of x, y, z, > 0
  double jerk_m_s3 = 0.0;                               ///< along the path; 0: acceleration changes instantly
  double cycle_s = 1e-3;                                ///< cycle time of the control's trajectory planner, > 0
};

}  // namespace driftwright
