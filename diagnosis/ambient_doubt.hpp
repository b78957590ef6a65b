#pragma once
// What a recorded ambient temperature is off by beside an offset: the noise of its thermometer and the steps that it reads in. A machine that follows the true
// ambient has none of them, and they are no finding.

#include "diagnosis/comparison.hpp"
#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

/// Readings of an ambient that is off by one standard deviation, n_outputs x n_times of each run: over each of twelve stretches of a record, for as long as steps of a slow temperature last, and in the first
/// row, from which a machine may start.
[[nodiscard]] std::vector<Prediction> ambient_columns(const Twin& twin, const std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
