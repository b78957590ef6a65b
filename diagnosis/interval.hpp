#pragma once
// The values of one number that the data allow.

#include "diagnosis/fit.hpp"

namespace driftwright::diagnosis {

struct Interval {
  double low = 0.0, high = 0.0;  ///< of x
};

/// 95 % interval by profile likelihood: where Φ, with all other numbers fitted anew, is 1.92 above its minimum. It is
/// skewed if the data are, and ends at the knob's bounds. A number without a slope, such as the time of a step in a
/// reading, is followed row by row.
/// Source: Venzon & Moolgavkar, J. R. Stat. Soc. C 37 (1988) 87-94.
/// @param claim, knob  indices in the hypothesis
[[nodiscard]] Interval profile_interval(const Fitter& fitter, const Hypothesis& hypothesis, const Fit& best,
                                        std::size_t claim, std::size_t knob);

}  // namespace driftwright::diagnosis
