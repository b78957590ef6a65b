#pragma once
// Minutes of warm-up against micrometres, with the drift corrected beside: by each strategy that `validate` judges.

#include "studies/warm_up_trials.hpp"

namespace driftwright::studies {

/// Strategies are fitted on the scenario's `validation`, with a model that is off by its `model_scatter`, and followed from the run's start on through
/// warm-up and job, by readings with its noise; the model as it is tells what is true. None for a scenario without `validation` and `study`, or whose
/// effects change what instruments read.
/// @param speed_rpm, longest_s  of the warm-up
[[nodiscard]] std::optional<CorrectedWarmUps> corrected_warm_ups(const scenarios::Scenario& scenario,
                                                                 const WarmUpTrials& trials, double speed_rpm,
                                                                 double longest_s, double tolerance_um,
                                                                 const Listener& listener);

}  // namespace driftwright::studies
