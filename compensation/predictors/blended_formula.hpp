#pragma once
// Combines formulas: adds a term, or averages several formulas into one.

#include <span>

#include "compensation/predictors/drift_model.hpp"

namespace driftwright::compensation {

/// Adds a term; if a term differs only in its coefficient, adds the coefficients.
void add_term(DriftModel& model, DriftModel::Term term);

/// The mean of several formulas. @param models  at least one, with the same target; equal terms are merged
[[nodiscard]] DriftModel mean_of(std::span<const DriftModel> models, std::string kind);

}  // namespace driftwright::compensation
