#pragma once
// Are A and B swapped? Then the encoder counts against the commanded direction, and the position loop runs away.

#include <algorithm>
#include <cmath>

namespace driftwright::compensation {

/// Adds up what the encoder counts against the speed that the control commands, from where it begins to until it counts along again.
class DirectionWatch {
 public:
  /// @param commanded_um  way that the speed command asked for since the last call
  /// @param counted_um    way that the encoder told
  /// @param way_um        > 0; half of it may be counted against the command. That of the call in which this begins holds: four times what
  ///                      the axis needs to stop from its speed then, for a sound axis that is reversed counts so while it brakes
  /// @return true once the encoder has counted against a command of way_um by more than half of that
  bool step(double commanded_um, double counted_um, double way_um) {
    if (commanded_um * commanded_um_ < 0.0) commanded_um_ = against_um_ = 0.0;  // a new direction, a new comparison
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
