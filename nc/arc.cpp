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
constexpr double kSameAngle = 1e-9;  // above the noise of atan2, 1e-13 for coordinates of 1 m and radii of 1 mm
constexpr double kRelativeTolerance = 1e-3, kMostRelative_m = 5e-4;

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
                 int normal, bool clockwise, int turns, double rounding_m) {
  const auto [u, v] = plane_axes(normal);
  const double radius_start_m = std::hypot(start[u] - centre[u], start[v] - centre[v]);
  const double radius_end_m = std::hypot(end[u] - centre[u], end[v] - centre[v]);
  if (!(radius_start_m > kSamePoint_m)) throw RangeError("the arc has radius zero; its centre is its starting point");
  if (!(radius_end_m > kSamePoint_m)) throw RangeError("the arc has radius zero at its end; its centre is its end point");
  ArcPath path;
  path.radius_m = 0.5 * (radius_start_m + radius_end_m);
  const double of_rounding_m = 4.0 * std::numbers::sqrt2 * rounding_m;
  const double allowed_m = std::max(of_rounding_m, std::min(kMostRelative_m, kRelativeTolerance * path.radius_m));
  if (!(std::abs(radius_start_m - radius_end_m) <= allowed_m)) {
    throw RangeError(
        fmt::format("the arc starts {:.4f} mm from its centre and ends {:.4f} mm from it; a difference of up to {:.4f} mm "
                    "is allowed",
                    1e3 * radius_start_m, 1e3 * radius_end_m, 1e3 * allowed_m));
  }
  const double sense = clockwise ? -1.0 : 1.0;
  const double from = std::atan2(start[v] - centre[v], start[u] - centre[u]);
  double sweep = 2.0 * kPi;  // positive in the direction of the arc
  if (std::hypot(end[u] - start[u], end[v] - start[v]) > kSamePoint_m) {
    sweep = sense * (std::atan2(end[v] - centre[v], end[u] - centre[u]) - from);
    if (sweep <= kSameAngle) sweep += 2.0 * kPi;
    if (sweep <= kSameAngle) sweep = 2.0 * kPi;
  }
  sweep += 2.0 * kPi * (turns - 1);
  const double rise_m = end[normal] - start[normal];
  const double growth_m = (radius_end_m - radius_start_m) / sweep;  // of the radius, per radian
  path.length_m = std::hypot(path.radius_m * sweep, radius_end_m - radius_start_m, rise_m);
  const double turned = sense * std::atan2(growth_m, path.radius_m);
  const double high = std::max(from, from + sense * sweep) - turned, low = std::min(from, from + sense * sweep) - turned;
  const double per_angle_m = std::hypot(path.radius_m, growth_m);
  path.travel_m[u] = per_angle_m * (integral_of_abs_sin(high) - integral_of_abs_sin(low));
  path.travel_m[v] = per_angle_m * (integral_of_abs_sin(high + kPi / 2) - integral_of_abs_sin(low + kPi / 2));
  path.travel_m[normal] = std::abs(rise_m);
  for (int axis = 0; axis < 3; ++axis) {
    path.low_m[axis] = std::min(start[axis], end[axis]);
    path.high_m[axis] = std::max(start[axis], end[axis]);
  }
  const double first = std::min(from, from + sense * sweep), last = first + std::min(sweep, 2.0 * kPi);
  for (long quarter = std::lround(std::ceil(first / (kPi / 2))); static_cast<double>(quarter) * kPi / 2 <= last; ++quarter) {
    const int axis = quarter % 2 == 0 ? u : v;  // which is at an extreme there
    const bool is_high = ((quarter % 4) + 4) % 4 < 2;
    double& extreme_m = is_high ? path.high_m[axis] : path.low_m[axis];
    const double there_m = centre[axis] + (is_high ? path.radius_m : -path.radius_m);
    extreme_m = is_high ? std::max(extreme_m, there_m) : std::min(extreme_m, there_m);
  }
  const auto direction = [&](double angle, double radius_m) {
    std::array<double, 3> way_m = {0, 0, 0};  // per radian
    way_m[u] = growth_m * std::cos(angle) - sense * radius_m * std::sin(angle);
    way_m[v] = growth_m * std::sin(angle) + sense * radius_m * std::cos(angle);
    way_m[normal] = rise_m / sweep;
    const double length_m = std::hypot(way_m[0], way_m[1], way_m[2]);
    for (double& w : way_m) w /= length_m;
    return way_m;
  };
  path.begins = direction(from, radius_start_m);
  path.ends = direction(from + sense * sweep, radius_end_m);
  return path;
}

std::array<double, 3> arc_centre(const std::array<double, 3>& start, const std::array<double, 3>& end, double radius_m,
                                 int normal, bool clockwise, double rounding_m) {
  const auto [u, v] = plane_axes(normal);
  const double du = end[u] - start[u], dv = end[v] - start[v], half_chord_m = 0.5 * std::hypot(du, dv);
  if (!(half_chord_m > kSamePoint_m))
    throw RangeError("an arc with R must end elsewhere than it starts; a whole circle is written with I, J, K");
  const double radius_abs_m = std::abs(radius_m);
  const double allowed_m = (1.0 + std::numbers::sqrt2) * rounding_m;
  if (!(half_chord_m <= radius_abs_m + allowed_m)) {
    throw RangeError(
        fmt::format("an arc of radius {:.4f} mm cannot reach a point {:.4f} mm away; the radius must be at least {:.4f} mm",
                    1e3 * radius_abs_m, 2e3 * half_chord_m, 1e3 * (half_chord_m - allowed_m)));
  }
  const double height_m = std::sqrt(std::max(0.0, radius_abs_m * radius_abs_m - half_chord_m * half_chord_m));
  // The centre of a short counterclockwise arc and of a long clockwise one is to the left of the chord.
  const double left = clockwise == (radius_m < 0.0) ? height_m : -height_m;
  std::array<double, 3> centre = start;
  centre[u] = start[u] + 0.5 * du - left * dv / (2.0 * half_chord_m);
  centre[v] = start[v] + 0.5 * dv + left * du / (2.0 * half_chord_m);
  return centre;
}

}  // namespace driftwright
