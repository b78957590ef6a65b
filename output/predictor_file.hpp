#pragma once
// A predictor as a file: what `validate` has fitted and judged is what `compensate` reads, to the last digit.

#include <nlohmann/json.hpp>
#include <string>

#include "compensation/predictors/deployed_predictor.hpp"
#include "effects/effect.hpp"
#include "output/results_folder.hpp"

namespace driftwright::output {

struct PredictorFile {
  compensation::DeployedPredictor predictor;
  /// Under which conditions it was judged, and the verdict: as `validate` wrote it (docs/how-to/validation.md). null where nobody has judged it.
  nlohmann::ordered_json judged;
};

/// @param effects  of the machine whose model it uses; empty for one that uses none
/// @throws std::logic_error  for a predictor of a kind that no file holds
[[nodiscard]] nlohmann::ordered_json predictor_json(const PredictorFile& file, const std::vector<effects::Effect>& effects,
                                                    const Provenance& made_by);

/// @param path  of a JSON file as predictor_json() makes it
/// @throws InputError  for a file that is none, naming the key
[[nodiscard]] PredictorFile read_predictor(const std::string& path);

}  // namespace driftwright::output
