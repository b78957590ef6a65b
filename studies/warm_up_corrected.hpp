#pragma once
// The drift of a job against the minutes of warm-up when the drift is also corrected, for each strategy that `validate`
// judges.

#include "studies/warm_up_trials.hpp"

namespace driftwright::studies {

/// Strategies are fitted on the scenario's `validation`, with a model scattered by its `model_scatter`, and run from the
/// start through warm-up and job, with noisy readings; the unchanged model is the truth. None for a scenario without
/// `validation` and `study`, or with effects that change readings.
/// @param speed_rpm, longest_s  of the warm-up
[[nodiscard]] std::optional<CorrectedWarmUps> corrected_warm_ups(const scenarios::Scenario& scenario,
                                                                 const WarmUpTrials& trials, double speed_rpm,
                                                                 double longest_s, double tolerance_um,
                                                                 const Listener& listener);

}  // namespace driftwright::studies
