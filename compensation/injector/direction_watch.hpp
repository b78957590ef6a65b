#pragma once
// Detects swapped encoder lines A and B: the encoder then counts against the commanded direction, and the position loop runs
// away.

#include <algorithm>
#include <cmath>

namespace driftwright::compensation {

/// Sums what the encoder counts against the commanded speed, from the first such count until it counts with the command
/// again.
class DirectionWatch {
 public:
  /// Adds one interval.
  /// @param commanded_um  travel that the speed command asked for since the last call
  /// @param counted_um    travel that the encoder counted
  /// @param way_um  > 0; up to half of it may be counted against the command. The value of the call in which such counting
  ///                      begins applies. Use four times the stopping distance from the speed at that time, because a sound
  ///                      axis counts so while it brakes after a reversal
  /// @return true once the encoder has counted more than half of way_um against a command of way_um
  bool step(double commanded_um, double counted_um, double way_um) {
    if (commanded_um * commanded_um_ < 0.0) commanded_um_ = against_um_ = 0.0;  // compare anew after a change of direction
    commanded_um_ += commanded_um;
    if (commanded_um_ == 0.0) return swapped_;
    if (against_um_ == 0.0) way_um_ = way_um;
    against_um_ = std::max(0.0, against_um_ - counted_um * std::copysign(1.0, commanded_um_));
    swapped_ = swapped_ || (std::abs(commanded_um_) >= way_um_ && against_um_ > 0.5 * way_um_);
    return swapped_;
  }

 private:
  double way_um_ = 0.0;
  double commanded_um_ = 0.0, against_um_ = 0.0;
  bool swapped_ = false;
};

}  // namespace driftwright::compensation
