#pragma once
// Units that NC programs are written in.

#include <numbers>

namespace driftwright {

inline constexpr double kInch_m = 0.0254, kMillimetre_m = 1e-3;
/// One degree [rad].
inline constexpr double kDegree = std::numbers::pi / 180.0;

}  // namespace driftwright
