#pragma once
// Detects times under a header with the wrong unit: seconds under min, hours under seconds.

#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

/// Compares the twin as written with each run as recorded, and with its times multiplied and divided by 60; the rest of
/// the readings' course shows which is meant. No machine has all its capacities wrong by 60; a machine that is merely
/// slower or faster fits with a smaller factor.
/// @throws InputError  if other times leave less than 0.3 of the course, in the median of the channels, a third of what
/// the recorded times leave, and two thirds of what factors between (60^0.5, 60^0.75) leave
void require_plausible_times(const std::vector<MeasuredRun>& runs, const Twin& twin);

}  // namespace driftwright::diagnosis
