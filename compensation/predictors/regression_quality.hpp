#pragma once
// How far the coefficients of a regression can be trusted, and whether its inputs tell the same story twice.

#include <span>

#include "compensation/predictors/regression.hpp"

namespace driftwright::compensation {

struct RegressionQuality {
  double r_squared = 0.0;  ///< 1 - sum r^2 / sum (y - mean)^2, on the rows fitted
  double durbin_watson =
      0.0;  ///< sum (r_k - r_{k-1})^2 / sum r^2 within records: 2 for white residuals, near 0 for what drifts
  /// Standard error of each coefficient, target_unit per input unit: sqrt(s^2 [(X'X)^-1]_jj), s^2 = sum r^2 / (n - m - 1), X centred. For white
  /// residuals: with a Durbin-Watson figure far below 2 they are too small. NaN for an input that repeats others.
  std::vector<double> standard_error;
  /// Variance inflation factor of each input, 1 / (1 - R_j^2) with R_j of its regression on the others: 1 alone; above 10 the inputs
  /// share what they tell, above 1000 the coefficients are arbitrary. Infinite for an input that repeats others.
  std::vector<double> variance_inflation;
};

/// @throws InputError  as fit_regression()
/// Source: Belsley, Kuh & Welsch, Regression Diagnostics (1980), ch. 3; Durbin & Watson, Biometrika 37 (1950) 409.
[[nodiscard]] RegressionQuality regression_quality(std::span<const Record> records, const Regression& regression);

/// Two channels that move as one.
struct NearDuplicate {
  std::string first, second;
  double correlation = 0.0;
};
/// Pairs with |correlation| of at least 0.995 over all complete rows, strongest first.
[[nodiscard]] std::vector<NearDuplicate> near_duplicates(std::span<const Record> records,
                                                         const std::vector<std::string>& channels);

}  // namespace driftwright::compensation
