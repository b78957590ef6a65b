#pragma once
// Measures of how reliable the coefficients of a regression are, and whether its inputs are redundant.

#include <span>

#include "compensation/predictors/regression.hpp"

namespace driftwright::compensation {

struct RegressionQuality {
  double r_squared = 0.0;  ///< 1 - sum r^2 / sum (y - mean)^2, on the rows fitted
  /// Sum (r_k - r_{k-1})^2 / sum r^2 within records: 2 for white residuals, near 0 for residuals that drift.
  double durbin_watson = 0.0;
  /// Standard error of each coefficient, target_unit per input unit: sqrt(s^2 [(X'X)^-1]_jj), s^2 = sum r^2 / (n - m - 1), X
  /// centred. Valid for white residuals: with a Durbin-Watson figure far below 2 it is too small. NaN for an input that
  /// repeats others.
  std::vector<double> standard_error;
  /// Variance inflation factor of each input, 1 / (1 - R_j^2) with R_j of its regression on the others: 1 if independent;
  /// above 10 the inputs share information, above 1000 the coefficients are arbitrary. Infinite for an input that repeats
  /// others.
  std::vector<double> variance_inflation;
};

/// @throws InputError  as fit_regression()
/// Source: Belsley, Kuh & Welsch, Regression Diagnostics (1980), ch. 3; Durbin & Watson, Biometrika 37 (1950) 409.
[[nodiscard]] RegressionQuality regression_quality(std::span<const Record> records, const Regression& regression);

/// Two channels that are almost perfectly correlated.
struct NearDuplicate {
  std::string first, second;
  double correlation = 0.0;
};
/// Pairs with |correlation| of at least 0.995 over all complete rows, strongest first.
[[nodiscard]] std::vector<NearDuplicate> near_duplicates(std::span<const Record> records,
                                                         const std::vector<std::string>& channels);

}  // namespace driftwright::compensation
