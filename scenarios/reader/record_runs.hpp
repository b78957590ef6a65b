#pragma once
// Splits a long record into runs: where the drive restarts after a rest, and from which row on the history matters.

#include "base/machine_run.hpp"

namespace driftwright::scenarios {

/// Rows [first, last) of a record as a run, and the row from which its history matters.
struct RunRows {
  std::size_t history = 0, first = 0, last = 0;  ///< history <= first < last
  bool operator==(const RunRows&) const = default;
};

/// The rows in [first, last) at which the drive restarts after a rest of at least ten minutes. At rest the spindle turns
/// at most at 1 % of its top speed, and nothing feeds or cuts.
[[nodiscard]] std::vector<std::size_t> starts_after_rests(const MachineRun& run, std::size_t first, std::size_t last);

/// The rows [first, last) as one run. Its history begins at the last restart after a rest in which the machine came back
/// to balance, otherwise at the record's first row. In balance all temperatures (over the ambient, where it is known) and
/// displacements are back at their values in the record's first rows: within 5 % of their range in between, or within 0.2 K
/// and 0.5 um.
[[nodiscard]] RunRows whole_run(const MachineRun& run, std::size_t first, std::size_t last);

/// The rows [first, last) as runs that begin where the drive restarts after a rest; at most eight, split at the longest
/// rests. One run if there is no such rest, or the drive is not known.
[[nodiscard]] std::vector<RunRows> runs_between_rests(const MachineRun& run, std::size_t first, std::size_t last);

/// The part of a cyclogram between two times; it keeps its name.
[[nodiscard]] Cyclogram part_of(const Cyclogram& cyclogram, double from_s, double until_s);
/// The part of a series between two times, with times from 0 on; empty for an empty series.
[[nodiscard]] TimeSeries part_of(const TimeSeries& series, double from_s, double until_s);

}  // namespace driftwright::scenarios
