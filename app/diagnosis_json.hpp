#pragma once
// diagnosis.json, in the form that outsiders rely on (docs/diagnosis.md).

#include <nlohmann/json_fwd.hpp>

#include "diagnosis/diagnosis.hpp"

namespace driftwright::app {

[[nodiscard]] nlohmann::ordered_json diagnosis_json(const diagnosis::Diagnosis& d);

}  // namespace driftwright::app
