#pragma once
// Regressions beside plain least squares, each ending in a DriftModel. What each leaves open (penalty, number of components, lags)
// is decided by the error on runs left out, never by the fit.

#include <limits>
#include <span>

#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/regression.hpp"

namespace driftwright::compensation {

/// What was fitted, and what was found on the way.
struct FittedFormula {
  DriftModel model;
  std::string reason;          ///< what was decided by the runs left out, one sentence
  double held_out_rmse = 0.0;  ///< of those, target unit
};

/// Plain least squares as a DriftModel.
[[nodiscard]] DriftModel as_drift_model(const Regression& regression);

/// Ridge regression: |y - X b|^2 + penalty n |b|^2 on columns of unit deviation. Source: Hoerl & Kennard, Technometrics 12 (1970) 55.
[[nodiscard]] FittedFormula fit_ridge(std::span<const Record> records, const std::vector<std::string>& inputs,
                                      const std::string& target);
/// Regression on the first principal components of columns of unit deviation. Source: Jolliffe, Principal Component Analysis (2002), ch. 8.
[[nodiscard]] FittedFormula fit_principal_components(std::span<const Record> records, const std::vector<std::string>& inputs,
                                                     const std::string& target);
/// Partial least squares (one target). Source: de Jong, Chemometrics Intell. Lab. Syst. 18 (1993) 251 (SIMPLS).
[[nodiscard]] FittedFormula fit_partial_least_squares(std::span<const Record> records,
                                                      const std::vector<std::string>& inputs, const std::string& target);
/// Regression with lags, the transfer-function form of ARX that is stable by construction: each input at once and behind one
/// first-order lag that all share, y = b0 + sum_j (b_j x_j + c_j L[x_j]), ridge penalty and lag by runs left out.
/// @param longest_s  no lag is longer; @throws InputError  where none is shorter
[[nodiscard]] FittedFormula fit_with_lags(std::span<const Record> records, const std::vector<std::string>& inputs,
                                          const std::string& target,
                                          double longest_s = std::numeric_limits<double>::infinity());
/// Transfer functions from the drive alone: speed and its square behind one, two or three lags, the ambient (if it is a channel) behind one.
/// @param drive  channel in rpm; @param ambient  channel or ""; @param longest_s  as above
[[nodiscard]] FittedFormula fit_from_speed(std::span<const Record> records, const std::string& drive,
                                           const std::string& ambient, const std::string& target,
                                           double longest_s = std::numeric_limits<double>::infinity());
// All: @throws InputError  as product_sums(), and for fewer than two records.

}  // namespace driftwright::compensation
