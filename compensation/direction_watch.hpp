#pragma once
// Are A and B swapped? Then the encoder counts against the commanded direction, and the position loop runs away.

#include <cmath>

namespace driftwright::compensation {

/// Compares the speed that the control commands with what the encoder counts, over every so much commanded way.
class DirectionWatch {
 public:
  /// @param way_um  commanded way after which the two are compared, > 0
  explicit DirectionWatch(double way_um) : way_um_(way_um) {}

  /// Another way to compare over: it must be longer than the axis takes to stop, or every stop would look like a swap.
  void set_way(double way_um) { way_um_ = way_um; }

  /// @param commanded_um  way that the speed command asked for since the last call
  /// @param counted_um    way that the encoder told
  /// @return true once the encoder has counted backward by at least half of a commanded way
  bool step(double commanded_um, double counted_um) {
    if (commanded_um * commanded_um_ < 0.0) commanded_um_ = counted_um_ = 0.0;  // a new direction, a new comparison
    commanded_um_ += commanded_um;
    counted_um_ += counted_um;
    if (std::abs(commanded_um_) < way_um_) return swapped_;
    const double along_um = std::copysign(counted_um_, counted_um_ * commanded_um_);
    swapped_ = swapped_ || along_um < -0.5 * way_um_;
    commanded_um_ = counted_um_ = 0.0;
    return swapped_;
  }

 private:
  double way_um_;
  double commanded_um_ = 0.0, counted_um_ = 0.0;
  bool swapped_ = false;
};

}  // namespace driftwright::compensation
