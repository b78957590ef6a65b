#pragma once
// The pulse injector on a signal without time: one row in, rows out. It is connected between an encoder and the control, and
// moves the axis by adding steps to what the control counts. timed_injector is the same device with time stamps.
//
// Signs: error = actual - commanded position. For a tool that is +e too far, e/step counts are inserted forward. The control
// then believes that the axis is e farther than it is, and moves it by -e.

#include <cstdint>
#include <span>

#include "compensation/injector/quadrature.hpp"

namespace driftwright::compensation {

/// When steps may be inserted, and how many at a time.
struct InsertionRules {
  /// 4: one whole cycle, after which the output equals the encoder's signal again. 2 or 1: half or a quarter of it; from
  /// then on the output is that far ahead of the encoder, by legal steps, and is low at other positions than the encoder.
  int quarters = kQuartersPerPeriod;
  bool anywhere = false;  ///< true: also while a line is high; false: only while both of the encoder's lines are low
  bool bypass = false;    ///< true: acts as a wire: nothing is inserted, and faults of the encoder are passed on
};

/// Largest number of output rows per input row: two that a jump has skipped, the row itself, and one cycle.
inline constexpr std::size_t kMostRowsPerRow = 3 + kQuartersPerPeriod;

/// Inserts quarter steps until their number equals the target, at most one insertion after each row.
///
/// Guarantees for any input and any sequence of targets:
/// - count of the output = count of the encoder + inserted(), also during an insertion;
/// - it adds no illegal transition. One of the encoder (a jump) is not passed on: the output waits until the next step shows
///   the direction, and then passes through the skipped states; nothing is inserted until a whole period has followed;
/// - if the target is reached and inserted() is a multiple of a cycle, the output is identical to the input;
/// - a remainder of the target smaller than one insertion waits;
/// - the index line is the encoder's in all rows; no edge of it is added or lost.
class PulseInjector {
 public:
  /// @throws RangeError  when rules.quarters is not 1, 2 or 4
  explicit PulseInjector(const InsertionRules& rules = {});

  /// Total quarter steps to be inserted since construction, > 0 forward, < 0 backward.
  void set_target(std::int64_t quarters) { target_ = quarters; }

  /// Passes rows on and makes insertions after them.
  /// @param out  space for kMostRowsPerRow rows per row
  /// @return number of rows written
  [[nodiscard]] std::size_t run(std::span<const Lines> rows, Lines* out);

  [[nodiscard]] std::int64_t target() const { return target_; }
  [[nodiscard]] std::int64_t inserted() const { return inserted_; }  ///< quarter steps, forward minus backward
  [[nodiscard]] std::int64_t n_insertions() const { return n_insertions_; }
  [[nodiscard]] const EncoderReader& encoder() const { return encoder_; }  ///< the encoder as read so far

 private:
  Lines* step(Lines row, Lines* out);
  [[nodiscard]] bool is_due() const;

  InsertionRules rules_;
  EncoderReader encoder_;
  std::int64_t target_ = 0;
  std::int64_t inserted_ = 0;
  std::int64_t n_insertions_ = 0;
  std::int64_t out_phase_ = 0;
};

}  // namespace driftwright::compensation
