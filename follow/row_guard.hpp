#pragma once
// Checks the rows of a stream before they are used: rows that are late, doubled, swapped or missing, clocks that were
// set, and impossible values.
//
// A row is taken or passed over by its own time and the times of earlier rows alone: the same rows give the same answers,
// no matter how fast they arrive.
//
//   the same time as the row taken last                 passed over: doubled
//   earlier, by up to a short gap                       passed over: late
//   later, by up to a short gap                         taken; more than 2.5 usual steps count as missing rows
//   further off, in either direction                    passed over, until the next row confirms it by following it within a
//                                                       short gap. Then
//     later by up to a week                             taken: so much time has passed without rows
//     else                                              taken: the clock was set, and one usual step has passed
//
// A short gap is ten usual steps, but at least 30 s; before the first step it is an hour. The usual step is an
// exponential mean over about 30 rows.

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "follow/stream_row.hpp"

namespace driftwright::follow {

/// Faults of a row, in the order of fault_words().
enum class Fault {
  kUnreadableRow,
  kUnreadableValue,
  kOutOfRange,
  kDoubled,
  kLate,
  kUnconfirmed,
  kMissingRows,
  kGap,
  kClockSet,
  kCount
};
[[nodiscard]] const char* fault_words(Fault fault);

/// Number of each fault since the start.
using FaultCounts = std::array<std::int64_t, static_cast<std::size_t>(Fault::kCount)>;

struct JudgedRow {
  bool is_taken = false;
  double run_s = 0.0;   ///< time since the first row taken; it never decreases
  double step_s = 0.0;  ///< since the row taken before
  std::vector<Fault> faults;
};

class RowGuard {
 public:
  /// Its state, for the state file.
  struct State {
    bool has_row = false;
    double stamp_s = 0.0, run_s = 0.0;  ///< of the row taken last: by the source's clock, and since the start
    double usual_s = 0.0;               ///< usual step; 0: none yet
    bool has_candidate = false;
    double candidate_s = 0.0;  ///< time of a row that awaits confirmation
    FaultCounts counts{};
  };

  /// Judges the next row; impossible values are NaN afterwards.
  [[nodiscard]] JudgedRow judge(StreamRow& row, const std::vector<Channel>& channels);
  /// Counts a line that is no row.
  void count_unreadable() { count(Fault::kUnreadableRow); }

  [[nodiscard]] double usual_step_s() const { return state_.usual_s > 0.0 ? state_.usual_s : 1.0; }
  [[nodiscard]] double short_gap_s() const;
  [[nodiscard]] const State& state() const { return state_; }
  void recall(const State& state) { state_ = state; }

 private:
  void count(Fault fault) { ++state_.counts[static_cast<std::size_t>(fault)]; }
  State state_;
};

}  // namespace driftwright::follow
