#pragma once
// How the true ambient goes where its thermometer or that one's logger errs in time, and how air follows a machine that warms it.

#include "base/cyclogram.hpp"

namespace driftwright::effects {

/// The ambient that was recorded so much later (< 0: earlier) than it was: T(t) = recorded(t + late). The first or the last value stands in beyond the ends.
[[nodiscard]] TimeSeries of_late_clock(const TimeSeries& recorded, double late_s);

/// The ambient that a thermometer follows with one time constant: T = recorded + lag d(recorded)/dt, the slope taken over half of the lag.
/// @param lag_s  >= 0
[[nodiscard]] TimeSeries of_slow_thermometer(const TimeSeries& recorded, double lag_s);

/// An ambient that is off by size n / at_speed with a first-order lag, from nothing at the start of the cyclogram.
/// @param lag_s  > 0
[[nodiscard]] TimeSeries warmed_with_speed(const TimeSeries& recorded, const Cyclogram& cyclogram, double size_K,
                                           double at_speed_rpm, double lag_s);

}  // namespace driftwright::effects
