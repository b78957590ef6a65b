#pragma once
// Which values of one number the data allow.

#include "diagnosis/fit.hpp"

namespace driftwright::diagnosis {

struct Interval {
  double low = 0.0, high = 0.0;  ///< of x
};

/// 95 % by profile likelihood: where Φ, all other numbers fitted anew, is 1.92 above its least. Skewed where the data are; ends at the
/// knob's own bounds. A number without a slope, such as the time of a step in a reading, is followed row by row.
/// Source: Venzon & Moolgavkar, J. R. Stat. Soc. C 37 (1988) 87-94.
/// @param claim, knob  which of the hypothesis's
[[nodiscard]] Interval profile_interval(const Fitter& fitter, const Hypothesis& hypothesis, const Fit& best,
                                        std::size_t claim, std::size_t knob);

}  // namespace driftwright::diagnosis
