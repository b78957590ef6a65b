#pragma once
// What the programs for all controls write alike: lengths in millimetres, the numbers of the last measurement.

#include <numbers>
#include <string>

#include "compensation/frames/frame_programs.hpp"

namespace driftwright::compensation {

inline constexpr double kDegrees = 180.0 / std::numbers::pi;

/// In mm with so many decimals; no "-0.000".
[[nodiscard]] std::string mm(double m, int decimals = 4);

/// How far a touch goes from a ring's middle, beyond its wall [m].
[[nodiscard]] double search_m(const FrameProgram& program);

/// A line of the frame in force, without parentheses, which end a comment of LinuxCNC.
[[nodiscard]] std::string last_numbers(const FrameProgram& program);

/// A line of what the places count from.
[[nodiscard]] std::string origin_words(const FrameProgram& program);

/// What scaling X alone does to arcs in the plane X Y, in um of their radius.
[[nodiscard]] std::string arc_words(const FrameProgram& program);

/// The second touch of a height, from this far above the first, at this share of the feed: a probe that reports late by a servo cycle
/// then reports a tenth as deep.
inline constexpr double kBackOff_m = 0.5e-3, kSlowTouch = 0.1;

}  // namespace driftwright::compensation
