#pragma once
// Runs a record's correction through the pulse injector, row by row, on an axis that dithers about its position.

#include <cstdint>
#include <span>
#include <vector>

namespace driftwright::compensation {

/// What was inserted at each sample.
struct InjectionResult {
  std::vector<double> inserted_um;             ///< in force after each sample; residual = drift - inserted_um
  std::vector<std::int64_t> inserted_periods;  ///< the same in periods
  std::int64_t upstream_count = 0;             ///< 4x count of the encoder at the end
  std::int64_t downstream_count = 0;           ///< 4x count at the control: upstream_count + 4 inserted periods
  std::int64_t n_illegal = 0;                  ///< illegal transitions at the control; must be 0
  int max_periods_per_sample = 0;              ///< low windows in one dither: the largest number of insertions per sample
  double max_rate_um_s = 0.0;  ///< this limit over the longest time step; a slower drift is always followed without delay
};

/// Runs the requested correction through a PulseInjector.
///
/// At each sample the target becomes round(correction / period) and the axis makes one dither: from 00
/// forward by n_dither_periods, back by twice that, and home again. A servo needs milliseconds for this, so it
/// counts as one moment of the record. The dither passes 00 exactly 4 n_dither_periods times; each pass is
/// a low window for one period. A larger change is spread over the next samples. Once followed, the remaining error
/// half a period at most, once followed.
///
/// @param time_s            strictly increasing
/// @param correction_um     requested per sample = predicted error (actual - commanded); a missing value keeps
///                          the target
/// @param period_um         travel of one encoder period, > 0
/// @param n_dither_periods  amplitude of the dither, >= 1
/// @throws RangeError  when the period is not positive or the dither smaller than 1
/// @throws InputError  when the two series differ in length
[[nodiscard]] InjectionResult simulate_injection(std::span<const double> time_s, std::span<const double> correction_um,
                                                 double period_um, int n_dither_periods = 3);

}  // namespace driftwright::compensation
