#pragma once
// Reads and writes a drift formula and a fail-safe as JSON, with all digits.

#include <nlohmann/json_fwd.hpp>

#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/fail_safe.hpp"

namespace driftwright::output {

/// Kind, intercept and terms.
[[nodiscard]] nlohmann::ordered_json formula_json(const compensation::DriftModel& model);
/// @throws InputError  naming the key, for JSON that is no formula. The caller sets target and from_start, which belong
/// to the file
[[nodiscard]] compensation::DriftModel formula_of(const nlohmann::ordered_json& json);

[[nodiscard]] nlohmann::ordered_json fail_safe_json(const compensation::FailSafe& safe);
/// @throws InputError  naming the key, for JSON that is no fail-safe
[[nodiscard]] compensation::FailSafe fail_safe_of(const nlohmann::ordered_json& json);

}  // namespace driftwright::output
