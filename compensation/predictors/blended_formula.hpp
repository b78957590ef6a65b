#pragma once
// Formulas put together: a term more, the mean of several, which is a formula again.

#include <span>

#include "compensation/predictors/drift_model.hpp"

namespace driftwright::compensation {

/// Adds a term, or its coefficient to the one that is the same but for it.
void add_term(DriftModel& model, DriftModel::Term term);

/// @param models  at least one, of the same target; terms that are alike become one
[[nodiscard]] DriftModel mean_of(std::span<const DriftModel> models, std::string kind);

}  // namespace driftwright::compensation
