#pragma once
// The figures of ISO 230-3 of measured records, as `diagnose` and `calibrate` show them.

#include "findings/iso230_3_section.hpp"
#include "studies/measured_twin.hpp"

namespace driftwright::findings {

/// The figures of each record, with its file's name: all displacements and tilts in it, as recorded. A run that begins warm
/// has none, because the test must begin in balance.
/// @throws InputError  for a record that can no longer be read
[[nodiscard]] std::vector<Iso230Run> measured_iso230_3(const studies::MeasuredTwin& measured);

}  // namespace driftwright::findings
