#pragma once
// What records lack for a verdict.

#include <string>

#include "diagnosis/twin.hpp"

namespace driftwright::diagnosis {

/// Sentences for a user with too few records: missing channels, thermometers, speeds, and the interval and length that
/// are needed.
/// @param n_readings  existing ones  @param n_wanted  required number over all channels
[[nodiscard]] std::string what_is_missing(const Twin& twin, const std::vector<MeasuredRun>& runs, int n_readings,
                                          int n_wanted);

/// Least number of readings of all channels of all runs; with fewer, a verdict would be a guess.
inline constexpr Eigen::Index kFewestReadings = 60;
[[nodiscard]] Eigen::Index readings_of(const std::vector<MeasuredRun>& runs);
/// Faults in the records themselves; with several records, named by record.
[[nodiscard]] std::vector<DataFinding> data_findings(const std::vector<MeasuredRun>& runs);

/// Time [s] after which a machine that starts 1 K too warm at standstill is within 1/e of its ambient everywhere; at most
/// 400 h.
[[nodiscard]] double settling_time_s(const Twin& twin, const MeasuredRun& run);

}  // namespace driftwright::diagnosis
