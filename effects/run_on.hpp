#pragma once
// What goes with the spindle and for a while after it: a fan, a pump on a timer.

#include <functional>

#include "base/cyclogram.hpp"
#include "effects/doubt.hpp"

namespace driftwright::effects {

/// Whether the spindle turns, or has stopped less than a time ago, of a drive that with_run_on() was asked for.
[[nodiscard]] std::function<bool(const Drive&)> turns_or_has(double run_on_s);

/// The speed [rpm] from which a spindle that stands has stopped, less than a time ago; else 0: the highest within the minute before. Of such a drive as well.
[[nodiscard]] std::function<double(const Drive&)> stopped_from_rpm(double run_on_s);

/// A cyclogram whose sections carry the signal that these look for: split where the time behind a stop is over. As it was for no such time.
[[nodiscard]] Cyclogram with_run_on(Cyclogram recorded, double run_on_s);

/// The same of the drive that is recorded; nothing for no such time.
void add_run_on(double run_on_s, DriveChange& change);
/// The number `runs_on` [min] of a doubt, from a usual one on.
[[nodiscard]] DoubtedNumber doubted_run_on(double usual_min);

}  // namespace driftwright::effects
