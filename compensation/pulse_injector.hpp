#pragma once
// The pulse injector: sits between an encoder and the control, and moves the axis by adding encoder periods.
//
// Signs: error = actual - commanded position. A tool that is +e too far gets +e/period inserted forward. The
// control then believes that the axis stands e further than it does, and moves it by -e.

#include <array>
#include <cstdint>
#include <span>

#include "compensation/quadrature.hpp"

namespace driftwright::compensation {

/// Inserts whole A/B periods while A and B are both low, until as many as the target are in.
///
/// What holds for any input and any sequence of targets:
/// - downstream 4x count = upstream 4x count + 4 inserted();
/// - it adds no illegal transition: an inserted period starts and ends at 00, where the encoder stands;
/// - with the target reached, the output is the input, row for row;
/// - at most one period per low window, that is per unbroken run of rows at 00. An axis that rests therefore
/// gets one
///   period at most, one that rests elsewhere than at 00 none, until it moves by a period: the reach of a
///   period changed during standstill is limited, and a real machine relies on the servo's dither.
class PulseInjector {
 public:
  /// The number of periods that shall have been inserted since birth, > 0 forward, < 0 backward.
  void set_target(std::int64_t n_periods) { target_ = n_periods; }

  /// Passes one row of the encoder on and inserts a period behind it where one is due.
  /// @return the rows for the control, the encoder's own first: 1, or 5 with an inserted period
  ///         (00 | 10 11 01 00 forward, 00 | 01 11 10 00 backward). The span lives until the next step().
  [[nodiscard]] std::span<const QuadratureState> step(QuadratureState encoder);

  [[nodiscard]] std::int64_t target() const { return target_; }      ///< periods
  [[nodiscard]] std::int64_t inserted() const { return inserted_; }  ///< periods, forward minus backward

 private:
  std::int64_t target_ = 0;
  std::int64_t inserted_ = 0;
  bool window_used_ = false;  // this low window has had its period
  std::array<QuadratureState, 1 + kQuartersPerPeriod> rows_;
};

}  // namespace driftwright::compensation
