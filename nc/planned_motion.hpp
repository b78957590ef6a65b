#pragma once
// Times of real motion: what a trajectory planner with limited accelerations makes of a path, as LinuxCNC's does.

#include <array>
#include <optional>
#include <vector>

#include "nc/limits.hpp"

namespace driftwright {

/// A straight line, an arc or a standstill of a path.
struct PathPiece {
  double length_m = 0.0;                     ///< 0: the axes stand
  double wanted_m_s = 0.0;                   ///< its feed, or the speed of rapids
  std::array<double, 3> begins = {0, 0, 0};  ///< unit vector of its direction where it begins
  std::array<double, 3> ends = {0, 0, 0};    ///< and where it ends
  double radius_m = 0.0;                     ///< of an arc; 0: straight
  bool rapid = false;
  bool stops = false;       ///< at its end, whatever follows: exact stop, dwell, spindle, tool
  double blend_m = -1.0;    ///< how far corners may be cut (G64 P); < 0: as far as speed asks for (G64)
  double standing_s = 0.0;  ///< of a standstill
};

/// How long each piece takes, corners that are rounded shared between their two pieces.
///
/// Along a piece the path's acceleration is the most that no axis exceeds; on an arc of radius r it is split between
/// tangential and normal, v <= sqrt(0.866 a r). Through a corner of the half angle θ between two lines goes an arc that keeps within the blend
/// tolerance P and uses at most half of each line,
///
///     d = min(L1 / 2, L2 / 2, P cos θ / (1 - sin θ)),   R = d tan θ,   v = sqrt(0.866 a R)
///
/// with a of the plane's weakest axis, shortened to what the speed wants; other corners, and all beside an arc, are passed at the speed at which the change of velocity within one cycle is a quarter of a.
/// Speeds are lowered backward from the end of kLookAhead pieces, at which the planner must be able to stop, then forward; within a piece velocity rises and
/// falls at a. With a jerk limit each change of acceleration takes a / jerk more.
/// Against a headless LinuxCNC 2.9 (servo cycles in motion): 1500 lines of 0.1 to 0.2 mm along a wave and 1500 of 0.4 mm round a circle -0.7 and -0.3 %,
/// 40 corners of 90 degrees -0.2 %, arcs with corners beside them -2.8 %, where the planner blends in ways that are not followed here.
/// Source: LinuxCNC, "Trajectory Control" (user manual) and its planner (src/emc/tp: tp.c, blendmath.c).
[[nodiscard]] std::vector<double> planned_durations_s(const std::vector<PathPiece>& pieces, const NcLimits& limits);

inline constexpr std::size_t kLookAhead = 50;  ///< ARC_BLEND_OPTIMIZATION_DEPTH

}  // namespace driftwright
