#pragma once
// Regressions other than plain least squares; each results in a DriftModel. Free choices (penalty, number of components,
// lags) are made by the error on left-out runs, never by the error of the fit.

#include <limits>
#include <span>

#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/regression.hpp"

namespace driftwright::compensation {

/// The fitted model, and how it was chosen.
struct FittedFormula {
  DriftModel model;
  std::string reason;          ///< the choice that the left-out runs decided, one sentence
  double held_out_rmse = 0.0;  ///< error on the left-out runs, target unit
};

/// Plain least squares as a DriftModel.
[[nodiscard]] DriftModel as_drift_model(const Regression& regression);

/// Ridge regression: |y - X b|^2 + penalty n |b|^2 on columns of unit deviation. Source: Hoerl & Kennard, Technometrics 12
/// (1970) 55.
[[nodiscard]] FittedFormula fit_ridge(std::span<const Record> records, const std::vector<std::string>& inputs,
                                      const std::string& target);
/// Regression on the first principal components of columns of unit deviation. Source: Jolliffe, Principal Component Analysis
/// (2002), ch. 8.
[[nodiscard]] FittedFormula fit_principal_components(std::span<const Record> records, const std::vector<std::string>& inputs,
                                                     const std::string& target);
/// Partial least squares (one target). Source: de Jong, Chemometrics Intell. Lab. Syst. 18 (1993) 251 (SIMPLS).
[[nodiscard]] FittedFormula fit_partial_least_squares(std::span<const Record> records,
                                                      const std::vector<std::string>& inputs, const std::string& target);
/// Regression with lags, the transfer-function form of ARX that is stable by construction: each input directly and after one
/// first-order lag that all share, y = b0 + sum_j (b_j x_j + c_j L[x_j]). Left-out runs decide ridge penalty and lag.
/// @param longest_s  upper limit of the lag; @throws InputError  if no lag is shorter
[[nodiscard]] FittedFormula fit_with_lags(std::span<const Record> records, const std::vector<std::string>& inputs,
                                          const std::string& target,
                                          double longest_s = std::numeric_limits<double>::infinity());
/// Transfer functions of the drive alone: speed and its square after one, two or three lags, the ambient (if it is a
/// channel) after one.
/// @param drive  channel in rpm; @param ambient  channel or ""; @param longest_s  as above
[[nodiscard]] FittedFormula fit_from_speed(std::span<const Record> records, const std::string& drive,
                                           const std::string& ambient, const std::string& target,
                                           double longest_s = std::numeric_limits<double>::infinity());
// All: @throws InputError  as product_sums(), and for fewer than two records.

}  // namespace driftwright::compensation
