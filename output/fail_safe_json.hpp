#pragma once
// Reads and writes a fail-safe as JSON, with all digits.

#include <nlohmann/json_fwd.hpp>

#include "compensation/predictors/fail_safe.hpp"

namespace driftwright::output {

[[nodiscard]] nlohmann::ordered_json fail_safe_json(const compensation::FailSafe& safe);
/// @throws InputError  naming the key, for JSON that is no fail-safe
[[nodiscard]] compensation::FailSafe fail_safe_of(const nlohmann::ordered_json& json);

}  // namespace driftwright::output
