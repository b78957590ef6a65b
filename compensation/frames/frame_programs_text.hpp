#pragma once
// Text that the programs for all controls share: lengths in millimetres, the numbers of the last measurement.

#include <numbers>
#include <string>

#include "compensation/frames/axis_programs.hpp"
#include "compensation/frames/frame_programs.hpp"

namespace driftwright::compensation {

inline constexpr double kDegrees = 180.0 / std::numbers::pi;  ///< degrees per radian

/// A length in mm with this many decimals; never "-0.000".
[[nodiscard]] std::string mm(double m, int decimals = 4);

/// Length of a touch's path from a ring's centre, ending beyond its wall [m].
[[nodiscard]] double search_m(const FrameProgram& program);

/// "; limit of the scenario: no correction above 50 um", or "" without a limit.
[[nodiscard]] std::string limit_words(const FrameProgram& program);

/// A line with the frame in force, and the limit of corrections if there is one, without parentheses, because these end a
/// comment of LinuxCNC.
[[nodiscard]] std::string last_numbers(const FrameProgram& program);

/// A line that names the origin of the positions.
[[nodiscard]] std::string origin_words(const FrameProgram& program);

/// A line with the effect on arcs in the plane X Y of scaling X alone, in um of their radius.
[[nodiscard]] std::string arc_words(const FrameProgram& program);

/// The second touch of a height starts this far above the first [m] and uses this share of the feed: the error of a probe
/// that reports late by a servo cycle is then a tenth.
inline constexpr double kBackOff_m = 0.5e-3, kSlowTouch = 0.1;

/// The touch of one axis begins this far before the gauge and ends this far beyond it [m].
inline constexpr double kBeforeTouch_m = 5e-3, kBeyondTouch_m = 3e-3;

/// Feed of the way down to the gauge [mm/min]. It is a touch, too: at 0.5 m/s² a machine stops within 0.6 mm.
inline constexpr double kWayDown_mm_min = 1500.0;

/// Where a touch of one axis begins [m].
[[nodiscard]] Eigen::Vector3d before_touch_m(const AxisProgram& program);

/// The coordinate of the axis at which the touch ends without contact [m].
[[nodiscard]] double beyond_touch_m(const AxisProgram& program);

/// Lines that say where the gauge is, and the limits.
[[nodiscard]] std::string gauge_words(const AxisProgram& program);
[[nodiscard]] std::string bound_words(const AxisProgram& program);

}  // namespace driftwright::compensation
