#pragma once
// What a Machine holds.

#include "driftwright/machine.hpp"
#include "studies/prediction.hpp"

namespace driftwright {

struct Machine::Parts {
  scenarios::Scenario scenario;
  Listener listener;
  studies::PredictingModels predicting;
  studies::PredictingModels simulating;
};

/// The scenario as predictions run it.
[[nodiscard]] scenarios::Scenario as_predicted(const scenarios::Scenario& scenario);

}  // namespace driftwright
