#pragma once
// Tapping: a feed move along the thread, one pitch per turn.

#include "nc/execution.hpp"

namespace driftwright {

/// A straight line on which the spindle turns once for each pitch. @throws InputError  without speed or pitch
void tap_to(NcExecution& run, const std::array<double, 3>& target_m, double pitch_m, double speed_rpm);

}  // namespace driftwright
