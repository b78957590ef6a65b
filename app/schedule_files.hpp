#pragma once
// The files that `schedule` writes beside the corrected programs.

#include "studies/corrected_series.hpp"

namespace driftwright::app {

/// schedule.txt: the paper's notation, per program, axis and operation.
[[nodiscard]] std::string schedule_notation(const studies::CorrectedSeries& series);
/// schedule.csv: rows of time, line, and per axis what changes: increment, correction, offset; for a series the numbers
/// of the first and last part come first.
[[nodiscard]] std::string schedule_csv(const studies::CorrectedSeries& series, const std::vector<std::string>& comments);

}  // namespace driftwright::app
