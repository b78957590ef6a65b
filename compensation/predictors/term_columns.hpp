#pragma once
// Converts the terms of a formula into columns (readings with powers and lags) for a fit, and a fit of columns back into a
// formula.

#include <span>
#include <string>
#include <vector>

#include "compensation/predictors/drift_model.hpp"
#include "compensation/sensors/product_sums.hpp"

namespace driftwright::compensation {

/// Records with one channel per term.
struct TermColumns {
  std::vector<Record> records;          ///< with the rows of the original records; channels: the target, then one per term
  std::vector<std::string> names;       ///< of the terms' channels
  std::vector<DriftModel::Term> terms;  ///< with their units; coefficients 0
};

/// Lags are computed over the whole of each record, so that rows may be split afterwards.
/// @throws InputError  when there is no record, or one lacks the target or an input
[[nodiscard]] TermColumns term_columns(std::span<const Record> records, const std::vector<DriftModel::Term>& terms,
                                       const std::string& target);

/// A fit of some columns as a formula in the units of the readings.
/// @param columns  indices into `terms`, one for each slope of the fit; @param terms  one for each input of the sums
[[nodiscard]] DriftModel model_of(const ProductSums& sums, std::span<const int> columns, const ScaledFit& fit,
                                  const std::vector<DriftModel::Term>& terms, std::string kind);

}  // namespace driftwright::compensation
