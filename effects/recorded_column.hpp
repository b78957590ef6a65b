#pragma once
// How effects follow what is recorded beside the drive (Cyclogram::Column).

#include <functional>
#include <optional>
#include <string>

#include "effects/doubt.hpp"

namespace driftwright::effects {

/// Whether a column is one of the drive's own channels, with or without its unit: cutting_power_W, feed_x_mm_min, ...
[[nodiscard]] bool is_drive_channel(const std::string& column);

/// What a column says of a drive that with_signal() was asked for, in the column's unit; nothing where the cyclogram does not have it, and
/// before a run.
[[nodiscard]] std::function<std::optional<double>(const Drive&)> signal_of(const std::string& column, double lag_s);

/// A cyclogram whose sections carry the signal that signal_of() looks for: split where the column changes. Behind a lag (0: none) pieces of a
/// quarter of it at most have the mean of y, lag y' = c - y, y settled at the first row. As it was where it has no such column.
[[nodiscard]] Cyclogram with_signal(const Cyclogram& recorded, const std::string& column, double lag_s);

}  // namespace driftwright::effects
