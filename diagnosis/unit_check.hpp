#pragma once
// Detects correct numbers under a wrong header: degF or kelvin under degC, mm under um; and displacements with the wrong
// sign.

#include <string>

#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

/// Removes channels whose numbers have another unit than their header says, each with a finding, by the twin as written.
/// Temperatures: as foreign_temperature() (base/), against the twin's course. Displacements: a thousand times or a
/// thousandth of the twin's, within a factor of 5, and correlated with it (|correlation| > 0.6); or equal to minus the
/// twin's course to within three tenths, if the temperatures follow the twin.
/// @throws InputError  if no channel of a run is left
void leave_out_foreign_units(std::vector<MeasuredRun>& runs, const Twin& twin);

}  // namespace driftwright::diagnosis
