#pragma once
// Incremental encoder signals: two square waves A and B a quarter period apart, and an index line.
//
//     forward, A leads:   A B = 00 -> 10 -> 11 -> 01 -> 00        backward, B leads: the reverse order
//
// One signal period (cycle) is four quarter steps. A control counts each of them (x4), the edges of A (x2), or one of them
// (x1).

#include <array>
#include <cstdint>
#include <vector>

namespace driftwright::compensation {

/// Levels of the lines in one byte, one row of the signal: A in bit 0, B in bit 1, index in bit 2.
using Lines = std::uint8_t;
inline constexpr Lines kLineA = 1, kLineB = 2, kLineIndex = 4, kLinesAB = 3;

/// Quarter steps in one signal period.
inline constexpr int kQuartersPerPeriod = 4;

/// Position of A and B in the forward order: 00 -> 0, 10 -> 1, 11 -> 2, 01 -> 3.
[[nodiscard]] constexpr int phase_of(Lines lines) {
  constexpr std::array<int, 4> kPhase = {0, 1, 3, 2};
  return kPhase[lines & kLinesAB];
}
/// A and B at that position; any integer, taken modulo 4. The index is low.
[[nodiscard]] constexpr Lines lines_of_phase(std::int64_t phase) {
  constexpr std::array<Lines, 4> kLines = {0, 1, 3, 2};
  return kLines[static_cast<std::size_t>(phase & 3)];
}

/// Result of quarter_step() if both lines changed at once: an encoder cannot do that, and the direction is unknown.
inline constexpr int kJump = 2;
/// Quarter steps between two rows: 0, +1, -1 or kJump.
[[nodiscard]] constexpr int quarter_step(Lines before, Lines after) {
  constexpr std::array<std::int8_t, 16> kStep = [] {
    std::array<std::int8_t, 16> step{};
    for (unsigned i = 0; i < 16; ++i) {
      const int forward = (phase_of(static_cast<Lines>(i & 3)) - phase_of(static_cast<Lines>(i >> 2)) + 4) % 4;
      step[i] = static_cast<std::int8_t>(forward == 3 ? -1 : forward);
    }
    return step;
  }();
  return kStep[static_cast<std::size_t>((before & kLinesAB) << 2 | (after & kLinesAB))];
}

/// The rows of a motion of n quarter steps from the row `from`: |n| rows, without `from` itself.
/// @param n_quarters  > 0 forward (A leads), < 0 backward
[[nodiscard]] std::vector<Lines> motion_rows(Lines from, int n_quarters);

/// How a control counts; the number is that of counts in one signal period.
enum class Counting { kX1 = 1, kX2 = 2, kX4 = 4 };

/// Quarter steps in one count.
[[nodiscard]] constexpr int quarters_per_count(Counting counting) {
  return kQuartersPerPeriod / static_cast<int>(counting);
}

/// A control's counter. x4 counts every quarter step, x2 every edge of A, x1 the edges of A while B is low (between 00 and
/// 10), so that a motion there and back counts zero. Jumps are not counted, as in LinuxCNC's `encoder`; n_jumps() gives
/// their number.
class QuadratureCounter {
 public:
  /// @param start  the lines before the first row
  explicit QuadratureCounter(Lines start = 0, Counting counting = Counting::kX4) : last_(start), counting_(counting) {}

  void step(Lines lines);

  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] std::int64_t n_jumps() const { return n_jumps_; }

 private:
  Lines last_;
  Counting counting_;
  std::int64_t count_ = 0;
  std::int64_t n_jumps_ = 0;
};

/// Reads an encoder that may lose edges. After a jump the position is uncertain by two quarter steps; the direction of the
/// next step resolves it, and the jump is counted in this direction. A second jump before that cancels the first one: a
/// disturbance there and back.
class EncoderReader {
 public:
  /// Quarter steps that this row makes certain: 0, +-1, or +-3 if the step resolves a jump. The first row is the reference.
  int step(Lines lines) {
    if (!started_) {
      started_ = true;
      last_ = lines;
      return 0;
    }
    const int step = quarter_step(last_, lines);
    last_ = lines;
    if (step == 0) return 0;
    if (step == kJump) {
      ++n_jumps_;
      in_doubt_ = !in_doubt_;
      n_clean_ = 0;
      return 0;
    }
    n_clean_ += n_clean_ < kQuartersPerPeriod;
    const int certain = in_doubt_ ? 3 * step : step;
    in_doubt_ = false;
    count_ += certain;
    return certain;
  }

  [[nodiscard]] Lines lines() const { return last_; }          ///< of the last row
  [[nodiscard]] bool started() const { return started_; }      ///< a row has been read
  [[nodiscard]] std::int64_t count() const { return count_; }  ///< quarter steps that are certain
  [[nodiscard]] std::int64_t n_jumps() const { return n_jumps_; }
  [[nodiscard]] bool in_doubt() const { return in_doubt_; }
  /// True if a whole period without a jump has passed.
  [[nodiscard]] bool trusted() const { return !in_doubt_ && n_clean_ >= kQuartersPerPeriod; }

 private:
  Lines last_ = 0;
  bool started_ = false, in_doubt_ = false;
  int n_clean_ = kQuartersPerPeriod;
  std::int64_t count_ = 0;
  std::int64_t n_jumps_ = 0;
};

}  // namespace driftwright::compensation
