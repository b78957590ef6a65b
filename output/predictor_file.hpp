#pragma once
// A predictor as a file: `validate` writes what it fitted and judged, and `compensate` reads the same numbers.

#include <nlohmann/json.hpp>
#include <string>

#include "compensation/predictors/deployed_predictor.hpp"
#include "output/results_folder.hpp"

namespace driftwright::output {

/// The speeds and ambient temperatures of the runs that a predictor was fitted and judged on.
struct Covered {
  double most_rpm = 0.0;
  double low_degC = 0.0, high_degC = 0.0;
};

struct PredictorFile {
  compensation::DeployedPredictor predictor;
  /// The conditions under which it was judged, and the verdict, as `validate` wrote them (docs/how-to/validation.md);
  /// null if nothing has judged it.
  nlohmann::ordered_json judged;
  /// Limits of the watch of an observer (follow/watch_json.hpp); null: none.
  nlohmann::ordered_json watch = nullptr;
  std::optional<Covered> covered = {};  ///< of a predictor that is driven by speed and ambient
};

/// @throws std::logic_error  for a predictor with an input that nothing guards (unguarded_input()), for one that is not
///                           stored, and for one of a kind that is not in predictor_kinds()
[[nodiscard]] nlohmann::ordered_json predictor_json(const PredictorFile& file, const Provenance& made_by);

/// @param path  a JSON file as predictor_json() makes it
/// @throws InputError  for a file that is no predictor, naming the key, and for a predictor with an input that nothing
///                     guards
[[nodiscard]] PredictorFile read_predictor(const std::string& path);

}  // namespace driftwright::output
