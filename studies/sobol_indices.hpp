#pragma once
// Sobol' indices: how much of the variance of a result each varied number makes.

#include <cstddef>
#include <optional>
#include <vector>

namespace driftwright::studies {

/// A share with its 95 % interval. Estimates of small shares may be negative.
struct Share {
  double value = 0.0, low = 0.0, high = 0.0;
};

/// The indices of one number.
struct SobolIndex {
  Share first;  ///< share of the variance that the number makes alone: what is gained once it is known
  Share total;  ///< the same with everything it makes together with other numbers: what remains if only it is unknown
};

/// The indices of each number from the results of a saltelli_design(), with f of A, B and A_i (A with column i of B):
///
///     S_i  = mean f(B) (f(A_i) - f(A)) / V             (Saltelli 2010)
///     ST_i = mean (f(A) - f(A_i))² / (2 V)             (Jansen 1999)
///
/// V is the variance over A and B, and f counts from the mean over both. Samples with a missing result are left out.
/// Intervals: middle 95 % of 400 bootstrap resamples of the samples, with a fixed seed.
///
/// @param results   in the order of the design's rows; NaN: missing
/// @param n_numbers >= 1; results.size() must be a multiple of n_numbers + 2
/// @returns none for fewer than 8 whole samples, and for a constant result
/// Source: Saltelli et al., Comput. Phys. Commun. 181 (2010) 259-270; Jansen, Comput. Phys. Commun. 117 (1999) 35-43;
/// bootstrap: Archer, Saltelli & Sobol', J. Stat. Comput. Simul. 58 (1997) 99-120.
[[nodiscard]] std::optional<std::vector<SobolIndex>> sobol_indices(const std::vector<double>& results,
                                                                   std::size_t n_numbers);

}  // namespace driftwright::studies
