#pragma once
// A predictor's file for the machine of a scenario.

#include <string>

#include "output/predictor_file.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::app {

/// The predictor in a file, whose target must be a displacement of the scenario's machine if it has one.
/// @throws InputError  for another target, and as output::read_predictor()
[[nodiscard]] output::PredictorFile read_machine_predictor(const scenarios::Scenario& scenario, const std::string& path);

}  // namespace driftwright::app
