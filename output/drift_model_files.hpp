#pragma once
// A formula for the drift as a person and a controller read it: text, a C function. Each with its fail-safe.

#include <string>

#include "compensation/drift_model.hpp"
#include "compensation/fail_safe.hpp"

namespace driftwright::output {

/// A model and what keeps it safe.
struct DeployedModel {
  compensation::DriftModel model;
  compensation::FailSafe safe;
  double interval_um = 0.0;  ///< half width of its 95 % prediction interval; NaN: unknown
};

/// A formula that can be typed into a controller, with units and validity ranges.
[[nodiscard]] std::string formula_text(const DeployedModel& deployed);

/// C99 source of one function that gives the correction from readings, call by call, with fail-safe: the same numbers as
/// guarded(safe, r, model.predict(r.readings)) of r = repaired(safe, readings). Needs <math.h> alone; missing readings are NAN.
[[nodiscard]] std::string c_function(const DeployedModel& deployed, const std::string& made_by);

}  // namespace driftwright::output
