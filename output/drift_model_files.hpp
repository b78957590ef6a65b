#pragma once
// A formula for the drift and its fail-safe as text for people. (predictor_file writes it as JSON, drift_model_c as C.)

#include <string>

#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/fail_safe.hpp"

namespace driftwright::output {

/// A formula together with its fail-safe.
struct DeployedModel {
  compensation::DriftModel model;
  compensation::FailSafe safe;
  double interval_um = 0.0;  ///< half width of its 95 % prediction interval; NaN: unknown
};

/// A formula that can be typed into a control, with units and validity ranges.
[[nodiscard]] std::string formula_text(const DeployedModel& deployed);

}  // namespace driftwright::output
