#pragma once
// What a record would have to hold for a verdict.

#include <string>

#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

/// Sentences for a user whose records are too few: channels that are not there, thermometers, speeds, how often and how long.
/// @param n_readings  that there are  @param n_wanted  of all channels together
[[nodiscard]] std::string what_is_missing(const Twin& twin, const std::vector<MeasuredRun>& runs, int n_readings,
                                          int n_wanted);

/// Readings of all channels of all runs, below which a verdict would be guessing.
inline constexpr Eigen::Index kFewestReadings = 60;
[[nodiscard]] Eigen::Index readings_of(const std::vector<MeasuredRun>& runs);
/// What is wrong with the records themselves; where there are several, named by record.
[[nodiscard]] std::vector<DataFinding> data_findings(const std::vector<MeasuredRun>& runs);

/// Time after which a machine that starts 1 K too warm at standstill is within 1/e of its ambient everywhere [s]; at most 400 h.
[[nodiscard]] double settling_time_s(const Twin& twin, const MeasuredRun& run);

}  // namespace driftwright::diagnosis
