#pragma once
// Numbers that are right and a header that is not: degF or kelvin under degC, mm under um; displacements of the other sign.

#include <string>

#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

/// Takes channels out of the runs whose numbers are in another unit than their header says, each with a finding, by the twin as it is
/// written. Temperatures: as foreign_temperature() (base/), against the twin's own course. Displacements: a thousand times as much as the twin
/// has or a thousandth, within a factor of 5, and following it (|correlation| > 0.6); or minus the twin's course to three tenths of their own, where
/// the temperatures follow the twin.
/// @throws InputError  where no channel of a run is left
void leave_out_foreign_units(std::vector<MeasuredRun>& runs, const Twin& twin);

}  // namespace driftwright::diagnosis
