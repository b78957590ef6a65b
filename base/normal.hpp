#pragma once
// The standard normal distribution.

namespace driftwright {

/// Half width of the interval that contains 95 % of a normal number, in its standard deviations: normal_quantile(0.975) to
/// three digits. Every 95 % interval of the program that is computed from a standard deviation has this half width.
inline constexpr double kNormal95 = 1.96;
/// Median of the absolute value of a normal number, in its standard deviations: normal_quantile(0.75) to four digits. A
/// median of absolute deviations divided by it is a standard deviation that single outliers do not change.
inline constexpr double kNormalMedian = 0.6745;

/// x at which the standard normal distribution reaches p, to about 1e-16 relative.
/// Source: Wichura, algorithm AS 241 (PPND16), Applied Statistics 37 (1988) 477-484.
/// @throws RangeError  unless 0 < p < 1
[[nodiscard]] double normal_quantile(double p);

}  // namespace driftwright
