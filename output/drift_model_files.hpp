#pragma once
// A formula for the drift as a person and a program read it: text and JSON. Each with its fail-safe. (drift_model_c: as C.)

#include <nlohmann/json_fwd.hpp>
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

/// Everything, to the last digit.
[[nodiscard]] nlohmann::ordered_json model_json(const DeployedModel& deployed);
/// @param path  of a JSON file as model_json() makes it
/// @throws InputError  for a file that is none, naming the key
[[nodiscard]] DeployedModel read_model(const std::string& path);

}  // namespace driftwright::output
