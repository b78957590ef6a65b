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

}  // namespace driftwright::compensation
