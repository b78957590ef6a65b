#pragma once
// What diagnosis.json and calibration.json hold, for `driftwright schema` and the documentation.

#include <vector>

#include "output/result_keys.hpp"

namespace driftwright::findings {

/// Of diagnosis.json.
[[nodiscard]] std::vector<output::ResultKey> diagnosis_keys();
/// Of calibration.json: the same but for the scenario written, and with a warning.
[[nodiscard]] std::vector<output::ResultKey> calibration_keys();

}  // namespace driftwright::findings
