#pragma once
// The terms of a formula as columns: readings at their powers and with their lags, ready for a fit; and a fit of columns as a formula.

#include <span>
#include <string>
#include <vector>

#include "compensation/predictors/drift_model.hpp"
#include "compensation/sensors/product_sums.hpp"

namespace driftwright::compensation {

/// Records in which every term has a channel of its own.
struct TermColumns {
  std::vector<Record> records;          ///< as many rows as those they were made of; channels: the target, then one a term
  std::vector<std::string> names;       ///< of the terms' channels
  std::vector<DriftModel::Term> terms;  ///< with their units; coefficients 0
};

/// Lags run over the whole of each record, so that its rows may be parted afterwards.
/// @throws InputError  when there is no record, or one lacks the target or an input
[[nodiscard]] TermColumns term_columns(std::span<const Record> records, const std::vector<DriftModel::Term>& terms,
                                       const std::string& target);

/// A fit of some columns as a formula in the units of the readings.
/// @param columns  indices into `terms`, one for each slope of the fit; @param terms  one for each input of the sums
[[nodiscard]] DriftModel model_of(const ProductSums& sums, std::span<const int> columns, const ScaledFit& fit,
                                  const std::vector<DriftModel::Term>& terms, std::string kind);

}  // namespace driftwright::compensation
