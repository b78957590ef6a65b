#pragma once
// Errors of a recorded ambient temperature besides an offset: its thermometer's noise and resolution. The machine follows
// the true ambient, so these errors are no finding.

#include "diagnosis/comparison.hpp"
#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

/// Changes of the readings for an ambient error of one standard deviation, n_outputs x n_times for each run: in each of
/// twelve stretches of a record, as long as the thermometer's steps last when the temperature changes slowly, and in the
/// first row, from which a machine may start.
[[nodiscard]] std::vector<Prediction> ambient_columns(const Twin& twin, const std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
