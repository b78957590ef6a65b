#pragma once
// Lets effects follow a column that was recorded beside the drive (Cyclogram::Column).

#include <functional>
#include <optional>
#include <string>

#include "effects/doubt.hpp"

namespace driftwright::effects {

/// True if a column is one of the drive's own channels, with or without its unit: cutting_power_W, feed_x_mm_min, ...
[[nodiscard]] bool is_drive_channel(const std::string& column);

/// A function that reads the value of a column from a drive prepared by with_signal(), in the column's unit; none if the
/// cyclogram lacks the column, and before a run.
[[nodiscard]] std::function<std::optional<double>(const Drive&)> signal_of(const std::string& column, double lag_s);

/// The cyclogram with the signal that signal_of() reads in each section, split where the column changes. With a lag, y
/// follows lag y' = c - y from y = c at the first row; sections are then at most a quarter of the lag long and contain the
/// mean of y. Lag 0: none. Unchanged without the column.
[[nodiscard]] Cyclogram with_signal(const Cyclogram& recorded, const std::string& column, double lag_s);

}  // namespace driftwright::effects
