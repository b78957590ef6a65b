#pragma once
// Times under a header of another unit: seconds under min, hours under seconds.

#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

/// Holds the twin as it is written to each run as recorded and with its times 60 times as long and as short; what is left of the readings' course says
/// which is meant. No machine's capacities are wrong by 60, all of them at once; one that is merely slower or faster is met by a smaller factor.
/// @throws InputError  where other times leave less than 0.3 of the course, in the median of the channels, a third of what the recorded ones do and two
///                     thirds of what those between (60^0.5, 60^0.75) do
void require_plausible_times(const std::vector<MeasuredRun>& runs, const Twin& twin);

}  // namespace driftwright::diagnosis
