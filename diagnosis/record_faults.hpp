#pragma once
// A measured record without what nobody can use: holes in which the drive changed unseen, single readings that are none.

#include "base/record.hpp"
#include "diagnosis/measured_run.hpp"

namespace driftwright::diagnosis {

/// The longer side of a hole (more than five usual steps without a row, or without a speed) across which the speed changed: when it did is not
/// known. Holes without a change stay, and are said.
[[nodiscard]] Record without_holes(const Record& record, std::vector<DataFinding>& findings);

/// Readings that leap away from both neighbours and back become missing: -999, 85.0 of a broken wire.
[[nodiscard]] Record without_spikes(Record record, std::vector<DataFinding>& findings);

}  // namespace driftwright::diagnosis
