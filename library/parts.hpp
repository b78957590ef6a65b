#pragma once
// The private data of a Machine.

#include "driftwright/machine.hpp"
#include "studies/prediction.hpp"

namespace driftwright {

struct Machine::Parts {
  scenarios::Scenario scenario;
  Listener listener;
  studies::PredictingModels predicting;
  studies::PredictingModels simulating;
};

/// The scenario in the form that predictions use.
[[nodiscard]] scenarios::Scenario as_predicted(const scenarios::Scenario& scenario);

}  // namespace driftwright
