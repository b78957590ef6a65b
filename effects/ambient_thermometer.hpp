#pragma once
// The true ambient temperature when its thermometer or logger is late or slow, and when the machine warms the air around it.

#include "base/cyclogram.hpp"

namespace driftwright::effects {

/// The true ambient when it was recorded `late_s` too late (< 0: too early): T(t) = recorded(t + late). Beyond the ends the
/// first or last value applies.
[[nodiscard]] TimeSeries of_late_clock(const TimeSeries& recorded, double late_s);

/// The true ambient when its thermometer follows with a time constant: T = recorded + lag d(recorded)/dt, with the slope
/// taken over half of the lag.
/// @param lag_s  >= 0
[[nodiscard]] TimeSeries of_slow_thermometer(const TimeSeries& recorded, double lag_s);

/// The ambient with an added rise of size n / at_speed, which follows with a first-order lag and is zero at the start of the
/// cyclogram.
/// @param lag_s  > 0
[[nodiscard]] TimeSeries warmed_with_speed(const TimeSeries& recorded, const Cyclogram& cyclogram, double size_K,
                                           double at_speed_rpm, double lag_s);

}  // namespace driftwright::effects
