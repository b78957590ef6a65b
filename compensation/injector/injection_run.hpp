#pragma once
// A record's correction driven through the pulse injector, row by row, on an axis that dithers about its
// position.

#include <cstdint>
#include <span>
#include <vector>

namespace driftwright::compensation {

struct InjectionRun {
  std::vector<double> inserted_um;             ///< in force after each sample; residual = drift - inserted_um
  std::vector<std::int64_t> inserted_periods;  ///< the same, counted
  std::int64_t upstream_count = 0;             ///< 4x count of the encoder at the end
  std::int64_t downstream_count = 0;           ///< 4x count the control saw: upstream_count + 4 inserted periods
  std::int64_t n_illegal = 0;                  ///< illegal transitions the control saw; 0 or there is a bug
  int max_periods_per_sample = 0;              ///< low windows of one dither: more cannot be inserted per sample
  double max_rate_um_s = 0.0;  ///< that limit over the longest time step; a drift that is slower is never waited for
};

/// Lets the wanted correction run through a PulseInjector.
///
/// At each sample the target becomes round(correction / period) and the axis makes one dither: from 00
/// forward by n_dither_periods, back by twice that, and home again. That takes a servo milliseconds, so it
/// counts as one moment of the record. The dither comes by 00 exactly 4 n_dither_periods times, and each is
/// one low window for one period: a larger change spreads over the next samples. The correction left over is
/// half a period at most, once followed.
///
/// @param time_s            strictly increasing
/// @param correction_um     wanted per sample = predicted error (actual - commanded); a missing value keeps
/// the target
/// @param period_um         travel of one encoder period, > 0
/// @param n_dither_periods  amplitude of the dither, >= 1
/// @throws RangeError  when the period is not positive or the dither smaller than 1
/// @throws InputError  when the two series differ in length
[[nodiscard]] InjectionRun simulate_injection(std::span<const double> time_s, std::span<const double> correction_um,
                                              double period_um, int n_dither_periods = 3);

}  // namespace driftwright::compensation
