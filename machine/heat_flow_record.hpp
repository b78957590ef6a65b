#pragma once
// Who heats and who cools, in W over time, as a record.

#include "base/record.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::scenarios {

/// One channel in W per flow of heat and one, `stored`, for what the machine keeps. A row holds the mean power since the row
/// before, so that power times interval sums to the heat exactly, however short a pulse; the first row is empty.
///
/// Signs: sources, surroundings and prescribed temperatures > 0 heat the machine, and together they make `stored`. Flows within
/// it (films to a lumped node, joints) begin with `within_`, > 0 leave the surface, or side a of "a/b", and count in no sum.
/// Channel names are those of the flows with '_' for what no name may hold; a repeated one gets a number.
[[nodiscard]] Record heat_flow_record(const solver::Trajectory& run, const std::string& source);

}  // namespace driftwright::scenarios
