#pragma once
// Records with holes, in which nobody saw what drove the machine.

#include <map>

#include "diagnosis/comparison.hpp"
#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

/// What the drive of the holes leaves open in the readings: for the Fitter, columns whose amplitudes have a standard deviation of 1. A hole is parted the
/// finer the nearer to its end (1/2, 1/4, 1/8, 1/16, 1/16 of it); of each part
///
///     column = 1/2 (readings with all that the record shows of speed, feeds, cutting power and columns that drive the machine at its most there
///                   - readings with all of it at its least)
///
/// Least: at rest, columns at their smallest value. The run's own cyclogram holds the drive before the hole. Where rows go on and the speed alone is missing, the speed alone is
/// another one. Where the ambient was recorded, each part without rows has a column for it as well: warmer by as much as the ambient strays elsewhere in the record
/// from the line between the ends of stretches as long as the hole, or in the whole record where none is as long.
[[nodiscard]] std::vector<Prediction> hole_columns(const Twin& twin, const std::vector<MeasuredRun>& runs);

/// Readings that holes leave open by more than noise become missing: a file, which holds the drive, says nothing of them.
void leave_out_what_is_open(const Twin& twin, const std::map<std::string, NoiseModel>& noise, std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
