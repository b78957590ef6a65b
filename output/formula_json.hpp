#pragma once
// A formula for the drift, and a fail-safe, as JSON: everything, to the last digit.

#include <nlohmann/json_fwd.hpp>

#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/fail_safe.hpp"

namespace driftwright::output {

/// Kind, intercept and terms.
[[nodiscard]] nlohmann::ordered_json formula_json(const compensation::DriftModel& model);
/// @throws InputError  naming the key, for what is no formula. Target and from_start are the file's
[[nodiscard]] compensation::DriftModel formula_of(const nlohmann::ordered_json& json);

[[nodiscard]] nlohmann::ordered_json fail_safe_json(const compensation::FailSafe& safe);
/// @throws InputError  naming the key, for what is none
[[nodiscard]] compensation::FailSafe fail_safe_of(const nlohmann::ordered_json& json);

}  // namespace driftwright::output
