#pragma once
// All heat flows of a machine in W over time, as a record.

#include "base/record.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::scenarios {

/// One channel in W per heat flow, and `stored` for the heat that the machine stores. A row contains the mean power since
/// the previous row, so that power times interval sums to the heat exactly, however short a pulse; the first row is empty.
///
/// Signs: sources, surroundings and prescribed temperatures > 0 heat the machine; their sum is `stored`. Flows within
/// the machine (films to a lumped node, joints) begin with `within_`; > 0 leaves the surface, or side a of "a/b"; they are
/// not in the sum. Channel names are those of the flows, with '_' for characters that are not allowed; a repeated name gets
/// a number.
[[nodiscard]] Record heat_flow_record(const solver::Trajectory& run, const std::string& source);

}  // namespace driftwright::scenarios
