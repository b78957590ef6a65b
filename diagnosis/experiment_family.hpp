#pragma once
// Cyclograms that ask different questions of a machine, within what it has done so far.

#include "diagnosis/measured_run.hpp"

namespace driftwright::diagnosis {

/// Speeds and feeds no higher than those of the runs; six hours each. Without a speed there is no spindle in them, without feeds no axes.
[[nodiscard]] std::vector<Cyclogram> experiment_family(const std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
