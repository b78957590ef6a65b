#pragma once
// Records with holes, in which the drive is unknown.

#include <map>

#include "diagnosis/comparison.hpp"
#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

/// Uncertainty of the readings by the unknown drive of holes: columns for the Fitter whose amplitudes have a standard
/// deviation of 1. A hole is divided more finely towards its end (1/2, 1/4, 1/8, 1/16, 1/16 of it); for each part
///
///     column = 1/2 (readings with all speeds, feeds, cutting power and driving columns at their recorded maximum there
///                   - readings with all of them at their minimum)
///
/// Minimum: at rest, columns at their smallest value. The run's own cyclogram holds the drive before the hole. If only
/// the speed is missing from rows, only the speed is varied. If the ambient was recorded, each part without rows also has
/// a column for it: warmer by the usual deviation of the ambient, elsewhere in the record, from the line between the ends
/// of stretches as long as the hole, or of the whole record if none is as long.
[[nodiscard]] std::vector<Prediction> hole_columns(const Twin& twin, const std::vector<MeasuredRun>& runs);

/// Sets readings to missing that a hole makes uncertain by more than noise, since a file, which holds the drive, cannot
/// predict them.
void leave_out_what_is_open(const Twin& twin, const std::map<std::string, NoiseModel>& noise,
                            std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
