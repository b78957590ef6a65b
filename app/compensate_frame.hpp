#pragma once
// Predictors through the table's frame, beside the ring measurement.

#include "app/verbs.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::app {

/// @throws InputError  without a `table`, for a model that is none of `modes`, `observer`, `regression`, and where one needs a linear reduced model
void compensate_through_frame(const scenarios::Scenario& scenario, const CompensateOptions& options);

}  // namespace driftwright::app
