#pragma once
// Between a stream and what follows it: rows that are late, doubled, swapped or missing, clocks that are set, values that no machine has.
//
// A row is taken or passed over, by its own time and that of the rows before alone: the same rows give the same answers, at whatever pace they come.
//
//   the same time as the row taken last                 passed over: doubled
//   earlier, by up to a short gap                       passed over: late
//   later, by up to a short gap                         taken; more than 2.5 usual steps count as missing rows
//   further off, in either direction                    passed over, until the next row confirms it by following it within a short gap. Then
//     later by up to a week                             taken: so much time has passed without rows
//     else                                              taken: the clock was set, and one usual step has passed
//
// A short gap is ten usual steps, and 30 s at least, an hour before there was a step; a usual step is the mean of the last steps of about 30 rows.

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "follow/stream_row.hpp"

namespace driftwright::follow {

/// What is wrong with a row, in the order of fault_words().
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

/// Faults and how many of each, since the start.
using FaultCounts = std::array<std::int64_t, static_cast<std::size_t>(Fault::kCount)>;

struct JudgedRow {
  bool is_taken = false;
  double run_s = 0.0;   ///< time since the first row taken, which only goes on
  double step_s = 0.0;  ///< since the row taken before
  std::vector<Fault> faults;
};

class RowGuard {
 public:
  /// What it knows, such as goes into a file.
  struct State {
    bool has_row = false;
    double stamp_s = 0.0, run_s = 0.0;  ///< of the row taken last: by the source's clock, and since the start
    double usual_s = 0.0;               ///< step; 0: none yet
    bool has_candidate = false;
    double candidate_s = 0.0;  ///< a row that awaits its confirmation
    FaultCounts counts{};
  };

  /// Judges the next row; values that no machine has are missing afterwards.
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
