#pragma once
// What nobody can use of a measured record: stretches in which nobody saw what drove the machine, single readings that are none.

#include "base/record.hpp"
#include "diagnosis/measured_run.hpp"

namespace driftwright::diagnosis {

/// Holes of a record: more than five usual steps without a row, or without a speed; usual in the whole record (of a logger that writes in bursts, from burst to burst), and in the five steps before or behind. What drove the machine in one is not known (unseen_drive.hpp).
/// @returns  from the last row with a speed to the next one, since the record's start; from the start on, or a step beyond the end, where there is none
[[nodiscard]] std::vector<Hole> holes_in(const Record& record, std::vector<DataFinding>& findings);

/// Readings that leap away from both neighbours and back become missing: -999, 85.0 of a broken wire.
[[nodiscard]] Record without_spikes(Record record, std::vector<DataFinding>& findings);

}  // namespace driftwright::diagnosis
