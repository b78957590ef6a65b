#pragma once
// The mean of several formulas, which is a formula again.

#include <span>

#include "compensation/predictors/drift_model.hpp"

namespace driftwright::compensation {

/// @param models  at least one, of the same target; terms that are alike become one
[[nodiscard]] DriftModel mean_of(std::span<const DriftModel> models, std::string kind);

}  // namespace driftwright::compensation
