#pragma once
// A reference ring measured from inside by four touches, and what a lagging probe does to it.

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>

#include "compensation/frames/touch_probe.hpp"

namespace driftwright::compensation {

/// Where four touches along +X, -X, +Y, -Y found the wall [m]; none where the probe found nothing.
struct RingTouches {
  std::optional<double> plus_x_m, minus_x_m, plus_y_m, minus_y_m;
};

struct RingCentre {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double diameter_m = 0.0;      ///< as found: ring less stylus ball, plus what lag and pre-travel add
  double scatter_m = 0.0;       ///< standard deviation of a round's centre, the larger axis; 0 for one round
  double out_of_round_m = 0.0;  ///< diameter along X less that along Y, mean of the rounds
};

/// Centre of a ring as the middle between opposite touches, the mean of all rounds: a lag that is the same both ways cancels.
/// @param free_diameter_m  ring less stylus ball; a diameter further from it than `tolerance_m` is a touch at the wrong side
/// @throws InputError  no round, a touch missing, touches that lie the wrong way round or at a wrong diameter
[[nodiscard]] RingCentre ring_centre(std::span<const RingTouches> rounds, double free_diameter_m, double tolerance_m = 1e-3);

/// What becomes of a touch: plain_m(), undone_m() ...
using ReadTouch = std::function<double(const Touch&, int axis)>;

struct RingProbing {
  double feed_m_s = 0.01;
  double free_diameter_m = 0.05;
  int rounds = 1;
};
/// Touches a ring that is really at `centre_m`.
[[nodiscard]] RingCentre measure_ring(const ProbeSystem& system, const RingProbing& probing, const Eigen::Vector2d& centre_m,
                                      const ReadTouch& read, Random& random);

}  // namespace driftwright::compensation
