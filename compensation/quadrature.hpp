#pragma once
// Incremental encoder signals: two square waves A and B a quarter period apart.
//
//     forward, A leads:   A B = 00 -> 10 -> 11 -> 01 -> 00        backward, B leads: the same read from right
//     to left
//
// One encoder period is four quarter steps; a 4x decoder counts each of them.

#include <cstdint>
#include <optional>
#include <vector>

namespace driftwright::compensation {

/// One row of the signal: the levels of A and B.
struct QuadratureState {
  bool a = false;
  bool b = false;

  friend bool operator==(const QuadratureState&, const QuadratureState&) = default;
};

/// Quarter steps in one encoder period.
inline constexpr int kQuartersPerPeriod = 4;

/// Place of a state in the forward order: 00 -> 0, 10 -> 1, 11 -> 2, 01 -> 3.
[[nodiscard]] int phase_of(QuadratureState state);
/// The state at that place; any integer, taken modulo 4.
[[nodiscard]] QuadratureState state_of_phase(std::int64_t phase);

/// The rows of a motion of n quarter steps that begins at `from`: |n| rows, `from` itself not among them.
/// @param n_quarters  > 0 forward (A leads), < 0 backward
[[nodiscard]] std::vector<QuadratureState> motion_rows(QuadratureState from, int n_quarters);

/// 4x decoder. The first row it sees, or the state given at birth, is its reference and counts nothing.
class QuadratureDecoder {
 public:
  QuadratureDecoder() = default;
  explicit QuadratureDecoder(QuadratureState start) : last_(start) {}

  /// Counts one row: +1 for a quarter step forward, -1 backward, 0 for no change. Both bits changing at once
  /// is illegal: the direction is unknown, so the count stays and n_illegal() rises.
  void step(QuadratureState state);

  [[nodiscard]] std::int64_t count() const { return count_; }          ///< quarter steps
  [[nodiscard]] std::int64_t n_illegal() const { return n_illegal_; }  ///< transitions that no encoder makes

 private:
  std::optional<QuadratureState> last_;
  std::int64_t count_ = 0;
  std::int64_t n_illegal_ = 0;
};

}  // namespace driftwright::compensation
