#pragma once
// Cyclograms that excite a machine in different ways, within the limits of its records.

#include "diagnosis/measured_run.hpp"

namespace driftwright::diagnosis {

/// Six hours each, with speeds and feeds no higher than in the runs. Without recorded speeds they have no spindle,
/// without feeds no axes.
[[nodiscard]] std::vector<Cyclogram> experiment_family(const std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
