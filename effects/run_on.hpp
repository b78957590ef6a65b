#pragma once
// Things that run with the spindle and for a while after it stops: a fan, a pump on a timer.

#include <functional>

#include "base/cyclogram.hpp"
#include "effects/doubt.hpp"

namespace driftwright::effects {

/// A function that is true if the spindle turns or stopped less than run_on_s ago. It needs a drive prepared by
/// with_run_on().
[[nodiscard]] std::function<bool(const Drive&)> turns_or_has(double run_on_s);

/// A function that gives the speed [rpm] before the stop of a spindle that stopped less than run_on_s ago: the highest
/// within the minute before the stop; else 0. It needs such a drive as well.
[[nodiscard]] std::function<double(const Drive&)> stopped_from_rpm(double run_on_s);

/// The cyclogram with the signal that these functions read, split where the time after a stop ends. Unchanged for run_on_s =
/// 0.
[[nodiscard]] Cyclogram with_run_on(Cyclogram recorded, double run_on_s);

/// Adds this to the changes of the drive; does nothing for run_on_s = 0.
void add_run_on(double run_on_s, DriveChange& change);
/// The number `runs_on` [min] of a doubt, with its usual value.
[[nodiscard]] DoubtedNumber doubted_run_on(double usual_min);

}  // namespace driftwright::effects
