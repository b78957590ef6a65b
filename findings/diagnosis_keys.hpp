#pragma once
// The keys of diagnosis.json and calibration.json, for `driftwright schema` and the documentation.

#include <vector>

#include "output/result_keys.hpp"

namespace driftwright::findings {

/// Keys of diagnosis.json.
[[nodiscard]] std::vector<output::ResultKey> diagnosis_keys();
/// Keys of calibration.json: the same except for the scenario written, and with a warning.
[[nodiscard]] std::vector<output::ResultKey> calibration_keys();

}  // namespace driftwright::findings
