#pragma once
// What goes with the spindle and for a while after it: a fan, a pump on a timer.

#include <functional>

#include "base/cyclogram.hpp"

namespace driftwright::effects {

/// Whether the spindle turns, or has stopped less than a time ago, of a drive that with_run_on() was asked for.
[[nodiscard]] std::function<bool(const Drive&)> turns_or_has(double run_on_s);

/// A cyclogram whose sections carry the signal that turns_or_has() looks for: split where the time behind a stop is over. As it was for no such time.
[[nodiscard]] Cyclogram with_run_on(const Cyclogram& recorded, double run_on_s);

}  // namespace driftwright::effects
