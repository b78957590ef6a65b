#pragma once
// The rows of runs that are fitted and scored: without their lead-in, and each reading once.

#include <span>
#include <string>
#include <vector>

#include "base/machine_run.hpp"

namespace driftwright::compensation {

/// The readings for fits and scores: temperatures and `target` counted from their first row if `from_start`, and the target
/// missing in the lead-in.
[[nodiscard]] Record scored_readings(const MachineRun& run, const std::string& target, bool from_start);

/// The rows of the run alone. Its time starts at 0.
[[nodiscard]] Record own_rows(Record readings, std::size_t n_before);

/// Merges runs of one history into one run, in which the target is missing in rows that belong to none of them; so each
/// reading counts once. Runs without a history are unchanged; the order is kept.
[[nodiscard]] std::vector<MachineRun> joined_histories(std::span<const MachineRun> runs, const std::string& target);

}  // namespace driftwright::compensation
