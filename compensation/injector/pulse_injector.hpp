#pragma once
// The pulse injector on a signal without time: row in, rows out. It sits between an encoder and the control, and moves the axis by
// adding steps to what the control counts. timed_injector is the same device in time.
//
// Signs: error = actual - commanded position. A tool that is +e too far gets +e/step counts inserted forward. The control then
// believes that the axis stands e further than it does, and moves it by -e.

#include <cstdint>
#include <span>

#include "compensation/injector/quadrature.hpp"

namespace driftwright::compensation {

/// When steps may be inserted, and how many at once.
struct InsertionRules {
  /// 4: one whole cycle, after which the output is the encoder's own signal again. 2 or 1: half or a quarter of it; from then on
  /// the output runs that far ahead of the encoder, by one of the legal steps, and is low at other places than the encoder.
  int quarters = kQuartersPerPeriod;
  bool anywhere = false;  ///< also while a line is high; else only while the encoder's lines are both low
  bool bypass = false;    ///< a wire: nothing is inserted, faults of the encoder are passed on too
};

/// Most rows that one row gives: two that a jump has skipped, itself, a cycle.
inline constexpr std::size_t kMostRowsPerRow = 3 + kQuartersPerPeriod;

/// Inserts until as many quarter steps as the target are in, one insertion behind a row at most.
///
/// What holds for any input and any sequence of targets:
/// - count of the output = count of the encoder + inserted(), also in the middle of an insertion;
/// - it adds no illegal transition. One of the encoder (a jump) is not passed on: the output waits until the next step has told the
///   direction, and then makes up for it through the states between; nothing is inserted until a whole period has followed;
/// - with the target reached and inserted() a multiple of a cycle, the output is the input, byte for byte;
/// - a rest of the target smaller than one insertion waits;
/// - the index line is the encoder's own in all rows; none of its edges is added or lost.
class PulseInjector {
 public:
  /// @throws RangeError  when rules.quarters is not 1, 2 or 4
  explicit PulseInjector(const InsertionRules& rules = {});

  /// Quarter steps that shall have been inserted since birth, > 0 forward, < 0 backward.
  void set_target(std::int64_t quarters) { target_ = quarters; }

  /// Passes rows on and inserts behind them.
  /// @param out  room for kMostRowsPerRow rows per row
  /// @return how many rows stand there
  [[nodiscard]] std::size_t run(std::span<const Lines> rows, Lines* out);

  [[nodiscard]] std::int64_t target() const { return target_; }
  [[nodiscard]] std::int64_t inserted() const { return inserted_; }  ///< quarter steps, forward minus backward
  [[nodiscard]] std::int64_t n_insertions() const { return n_insertions_; }
  [[nodiscard]] const EncoderReader& encoder() const { return encoder_; }  ///< what it has read

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
