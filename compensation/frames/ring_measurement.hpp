#pragma once
// Measures a reference ring from inside by four touches, including the effect of a lagging probe.

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>

#include "compensation/frames/touch_probe.hpp"

namespace driftwright::compensation {

/// Positions at which four touches along +X, -X, +Y, -Y found the wall [m]; none where the probe found nothing.
struct RingTouches {
  std::optional<double> plus_x_m, minus_x_m, plus_y_m, minus_y_m;
};

struct RingCentre {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double diameter_m = 0.0;      ///< as measured: ring less stylus ball, plus lag and pre-travel
  double scatter_m = 0.0;       ///< standard deviation of a round's centre, the larger axis; 0 for one round
  double out_of_round_m = 0.0;  ///< diameter along X less that along Y, mean over the rounds
};

/// Centre of a ring: the middle between opposite touches, averaged over all rounds. A lag that is equal in both directions
/// cancels.
/// @param free_diameter_m  ring less stylus ball; a diameter that differs by more than `tolerance_m` means a touch on the
///                     wrong side
/// @throws InputError  without a round, for a missing touch, touches in the wrong order or at a wrong diameter
[[nodiscard]] RingCentre ring_centre(std::span<const RingTouches> rounds, double free_diameter_m, double tolerance_m = 1e-3);

/// Computes a position from a touch: plain_m(), undone_m() ...
using ReadTouch = std::function<double(const Touch&, int axis)>;

struct RingProbing {
  double feed_m_s = 0.01;
  double free_diameter_m = 0.05;
  int rounds = 1;
};
/// Simulates probing a ring whose true centre is `centre_m`.
[[nodiscard]] RingCentre measure_ring(const ProbeSystem& system, const RingProbing& probing, const Eigen::Vector2d& centre_m,
                                      const ReadTouch& read, Random& random);

}  // namespace driftwright::compensation
