#include "nc/arc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/errors.hpp"

namespace driftwright {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSamePoint_m = 1e-9;
constexpr double kTolerance_m = 5e-6, kMostTolerance_m = 5e-4, kRelativeTolerance = 1e-3;

/// ∫ |sin φ| dφ from 0 to angle.
double integral_of_abs_sin(double angle) {
  const double half_turns = std::floor(angle / kPi);
  return 2.0 * half_turns + 1.0 - std::cos(angle - half_turns * kPi);
}

}  // namespace

std::array<int, 2> plane_axes(int normal) {
  return {(normal + 1) % 3, (normal + 2) % 3};
}

ArcPath arc_path(const std::array<double, 3>& start, const std::array<double, 3>& end, const std::array<double, 3>& centre,
                 int normal, bool clockwise, int turns) {
  const auto [u, v] = plane_axes(normal);
  const double radius_start_m = std::hypot(start[u] - centre[u], start[v] - centre[v]);
  const double radius_end_m = std::hypot(end[u] - centre[u], end[v] - centre[v]);
  const double radius_m = 0.5 * (radius_start_m + radius_end_m);
  if (!(radius_start_m > kSamePoint_m)) throw RangeError("the arc has radius zero; its centre is its starting point");
  const double mismatch_m = std::abs(radius_start_m - radius_end_m);
  if (!(mismatch_m <= kTolerance_m || (mismatch_m <= kMostTolerance_m && mismatch_m <= kRelativeTolerance * radius_m))) {
    throw RangeError(fmt::format("the arc starts {:.4f} mm from its centre and ends {:.4f} mm from it", 1e3 * radius_start_m,
                                 1e3 * radius_end_m));
  }
  const double from = std::atan2(start[v] - centre[v], start[u] - centre[u]);
  double sweep = 2.0 * kPi;  // counted positive in the sense of the arc
  if (std::hypot(end[u] - start[u], end[v] - start[v]) > kSamePoint_m) {
    sweep = std::atan2(end[v] - centre[v], end[u] - centre[u]) - from;
    if (clockwise) sweep = -sweep;
    if (sweep <= 0.0) sweep += 2.0 * kPi;
  }
  sweep += 2.0 * kPi * (turns - 1);
  const double low = clockwise ? from - sweep : from, high = low + sweep;
  const double rise_m = std::abs(end[normal] - start[normal]);
  ArcPath path;
  path.length_m = std::hypot(radius_m * sweep, rise_m);
  path.travel_m[u] = radius_m * (integral_of_abs_sin(high) - integral_of_abs_sin(low));
  path.travel_m[v] = radius_m * (integral_of_abs_sin(high + kPi / 2) - integral_of_abs_sin(low + kPi / 2));
  path.travel_m[normal] = rise_m;
  return path;
}

std::array<double, 3> arc_centre(const std::array<double, 3>& start, const std::array<double, 3>& end, double radius_m,
                                 int normal, bool clockwise) {
  const auto [u, v] = plane_axes(normal);
  const double du = end[u] - start[u], dv = end[v] - start[v], half_chord_m = 0.5 * std::hypot(du, dv);
  if (!(half_chord_m > kSamePoint_m))
    throw RangeError("an arc with R must end elsewhere than it starts; a whole circle is written with I, J, K");
  const double radius_abs_m = std::abs(radius_m);
  if (!(half_chord_m <= radius_abs_m + kTolerance_m)) {
    throw RangeError(fmt::format("an arc of radius {:.4f} mm cannot reach a point {:.4f} mm away", 1e3 * radius_abs_m,
                                 2e3 * half_chord_m));
  }
  const double height_m = std::sqrt(std::max(0.0, radius_abs_m * radius_abs_m - half_chord_m * half_chord_m));
  // Left of the chord lies the centre of a short counterclockwise arc and of a long clockwise one.
  const double left = clockwise == (radius_m < 0.0) ? height_m : -height_m;
  std::array<double, 3> centre = start;
  centre[u] = start[u] + 0.5 * du - left * dv / (2.0 * half_chord_m);
  centre[v] = start[v] + 0.5 * dv + left * du / (2.0 * half_chord_m);
  return centre;
}

}  // namespace driftwright
