#pragma once
// Numbers that are right and a header that is not: degF or kelvin under degC, mm under um.

#include <optional>
#include <string>

#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

/// Unit that temperatures under a degC header look like, or none: as they stand they lie more than 25 K beside what is known of them, read
/// as degF or kelvin at most a fifth as far.
/// @param readings  in the header's degC  @param low_C, high_C  where they should lie
[[nodiscard]] std::optional<std::string> foreign_temperature(const std::vector<double>& readings, double low_C,
                                                             double high_C);

/// Takes channels out of the runs whose numbers are in another unit than their header says, each with a finding, by the twin as it is
/// written. Temperatures: as foreign_temperature(), against the twin's own course. Displacements: a thousand times as much as the twin
/// has or a thousandth, within a factor of 5, and following it (|correlation| > 0.6).
/// @throws InputError  where no channel of a run is left
void leave_out_foreign_units(std::vector<MeasuredRun>& runs, const Twin& twin);

}  // namespace driftwright::diagnosis
