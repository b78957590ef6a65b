#pragma once
// Durations of real motion: a trajectory planner with limited accelerations, modelled on LinuxCNC's.

#include <array>
#include <optional>
#include <vector>

#include "nc/limits.hpp"

namespace driftwright {

/// A straight line, an arc or a standstill of a path.
struct PathPiece {
  double length_m = 0.0;                     ///< 0: the axes do not move
  double wanted_m_s = 0.0;                   ///< the feed, or the rapid speed
  std::array<double, 3> begins = {0, 0, 0};  ///< unit vector of its direction at its start
  std::array<double, 3> ends = {0, 0, 0};    ///< unit vector of its direction at its end
  double radius_m = 0.0;                     ///< of an arc; 0: straight
  bool rapid = false;
  bool stops = false;       ///< the axes stop at its end in any case: exact stop, dwell, spindle, tool
  double blend_m = -1.0;    ///< how far corners may be rounded (G64 P); < 0: as far as speed requires (G64)
  double standing_s = 0.0;  ///< duration of a standstill
};

/// Duration of each piece [s]; the time in a rounded corner is divided between its two pieces.
///
/// The acceleration a along a piece is the largest that exceeds no axis' limit. On an arc of radius r it is split between
/// tangential and normal, v <= sqrt(0.866 a r). A corner with the half angle θ between two lines is rounded by an arc that
/// keeps within the blend tolerance P and uses at most half of each line,
///
///     d = min(L1 / 2, L2 / 2, P cos θ / (1 - sin θ)),   R = d tan θ,   v = sqrt(0.866 a R)
///
/// with a of the weakest axis in the plane; the arc is shortened to what the speed requires. All other corners, including
/// those next to an arc, are passed at the speed at which the change of velocity within one cycle is a quarter of a. Speeds
/// are lowered backward from the end of kLookAhead pieces, where the planner must be able to stop, then forward; within a
/// piece the velocity rises and falls at a. With a jerk limit each change of acceleration takes a / jerk longer. Compared
/// with a headless LinuxCNC 2.9 (servo cycles in motion): 1500 lines of 0.1 to 0.2 mm along a wave -0.7 %, 1500 of 0.4 mm on
/// a circle -0.3 %, 40 corners of 90 degrees -0.2 %, arcs with corners beside them -2.8 %, where the planner blends in ways
/// not modelled here.
/// Source: LinuxCNC, "Trajectory Control" (user manual) and its planner (src/emc/tp: tp.c, blendmath.c).
[[nodiscard]] std::vector<double> planned_durations_s(const std::vector<PathPiece>& pieces, const NcLimits& limits);

/// Pieces that the planner looks ahead; LinuxCNC's ARC_BLEND_OPTIMIZATION_DEPTH.
inline constexpr std::size_t kLookAhead = 50;

}  // namespace driftwright
