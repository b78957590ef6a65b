#pragma once
// Which rows numbers are fitted to, and which are kept out to judge them on.

#include <vector>

#include "diagnosis/search.hpp"

namespace driftwright::diagnosis {

inline constexpr const char* kAheadWords =
    "the last third of the only record, predicted with numbers fitted to the first two thirds";

/// Rows that numbers are fitted to, and the others. Both have all runs; readings that are not theirs are missing.
struct Fold {
  std::vector<MeasuredRun> fitted, kept_out;
  std::vector<std::size_t> whole = {};  ///< runs that are kept out whole
  bool is_ahead = false;                ///< the end of the only run
  [[nodiscard]] bool is_searched() const { return !whole.empty() || is_ahead; }
};

/// Whether a claim happens at a time of its own.
[[nodiscard]] bool has_time(const Claim& claim);
/// The end of a single run.
[[nodiscard]] Fold ahead_of(const std::vector<MeasuredRun>& runs);

struct Folds {
  std::vector<Fold> list;
  std::string how;
};

/// Each run in turn; of a single one its last third; of one in which alone something happened blocks, every other one.
[[nodiscard]] Folds folds_of(const Fitter& fitter, const SearchResult& result, Twin::Workspace& workspace);

/// What judges numbers alone: each third of all runs in turn, and where there are several each run.
[[nodiscard]] Folds folds_of_numbers(const std::vector<MeasuredRun>& runs);

/// Runs of one duty cycle, each its numbers: speeds that are held for about as long, in whatever order. Cycles in the order of their first runs; a single one where
/// the spindle turns alike in all runs, or never.
[[nodiscard]] std::vector<std::vector<std::size_t>> duty_cycles(const std::vector<MeasuredRun>& runs);
/// Each duty cycle in turn, all its runs kept out; empty where there is one, or none has a second run: then each run is a cycle.
[[nodiscard]] std::vector<Fold> folds_of_cycles(const std::vector<MeasuredRun>& runs);

}  // namespace driftwright::diagnosis
