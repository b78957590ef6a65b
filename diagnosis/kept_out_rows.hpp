#pragma once
// Splits rows into those that numbers are fitted to and those that are kept out to judge them.

#include <vector>

#include "diagnosis/search.hpp"

namespace driftwright::diagnosis {

inline constexpr const char* kAheadWords =
    "the last third of the only record, predicted with numbers fitted to the first two thirds";

/// Fitted and kept-out rows. Both have all runs; the readings of the other part are missing (NaN).
struct Fold {
  std::vector<MeasuredRun> fitted, kept_out;
  std::vector<std::size_t> whole = {};  ///< runs that are kept out completely
};

/// Whether a claim happens at a certain time.
[[nodiscard]] bool has_time(const Claim& claim);
/// The fold that keeps out the end of a single run.
[[nodiscard]] Fold ahead_of(const std::vector<MeasuredRun>& runs);

struct Folds {
  std::vector<Fold> list;
  std::string how;
};

/// The folds: each run in turn; for a single run its last third; for a run that alone contains an event, blocks, every
/// other one.
[[nodiscard]] Folds folds_of(const Fitter& fitter, const SearchResult& result, Twin::Workspace& workspace);

/// The folds for numbers alone: each third of all runs in turn, and with several runs each run.
[[nodiscard]] Folds folds_of_numbers(const std::vector<MeasuredRun>& runs);

/// Indices of the runs of each duty cycle: speeds held for about the same time, in any order. Cycles are in the order of
/// their first runs; there is a single cycle if the spindle turns alike in all runs, or never.
[[nodiscard]] std::vector<std::vector<std::size_t>> duty_cycles(const std::vector<MeasuredRun>& runs);
/// Each duty cycle in turn, with all its runs kept out; empty if there is only one cycle, or if each run has its own.
[[nodiscard]] std::vector<Fold> folds_of_cycles(const std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
