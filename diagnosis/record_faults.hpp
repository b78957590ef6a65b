#pragma once
// Unusable parts of a measured record: stretches with an unknown drive, and single invalid readings.

#include "base/record.hpp"
#include "diagnosis/measured_run.hpp"

namespace driftwright::diagnosis {

/// Holes of a record: more than five usual steps without a row, or without a speed. The usual step is that of the whole
/// record (for a logger that writes in bursts, from burst to burst), and that of the five steps before or after. The
/// drive in a hole is unknown (unseen_drive.hpp).
/// @returns  times since the record's start, from the last row with a speed to the next one; from the start, or to one
/// step after the end, if there is none
[[nodiscard]] std::vector<Hole> holes_in(const Record& record, std::vector<DataFinding>& findings);

/// Sets readings to missing that jump away from both neighbours and back: -999, or 85.0 of a broken wire.
[[nodiscard]] Record without_spikes(Record record, std::vector<DataFinding>& findings);

}  // namespace driftwright::diagnosis
