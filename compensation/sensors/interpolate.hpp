#pragma once
// Interpolates a sampled series.

#include <span>

namespace driftwright::compensation {

/// Value of a sampled series at time t [s], linear between samples:
///
///     x(t) = x_i + (x_{i+1} - x_i) (t - t_i) / (t_{i+1} - t_i)     for t_i <= t <= t_{i+1}
///
/// NaN outside the samples and between two samples of which one is missing; at a sample exactly its value.
///
/// @param time_s  strictly increasing
/// @param values  same length, any unit; missing values are NaN
[[nodiscard]] double interpolate(std::span<const double> time_s, std::span<const double> values, double t_s);

}  // namespace driftwright::compensation
