#include "nc/planned_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace driftwright {
namespace {

// Share of the acceleration for the normal direction; 0.5 remains along the path.
constexpr double kNormalShare = 0.8660254037844386;
constexpr double kKinkShare = 0.25;

/// The largest value along a direction that exceeds no axis' limit.
double along(const std::array<double, 3>& limit, const std::array<double, 3>& direction) {
  double most = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(direction[axis]) > 1e-9) most = std::min(most, limit[axis] / std::abs(direction[axis]));
  }
  return most;
}

/// The part of a piece between its corners.
struct Stretch {
  double length_m = 0.0;
  double velocity_m_s = 0.0, acceleration_m_s2 = 0.0;
  double end_m_s = 0.0;   ///< largest speed at its end, into the next corner
  double corner_s = 0.0;  ///< time of that corner's arc
  double corner_m = 0.0;  ///< length of that corner's arc
};

/// Time of a straight motion from v0 to v1 with the acceleration a and the largest speed v. @param jerk_m_s3  0: no limit
double time_along(double length_m, double v0, double v1, double v, double a, double jerk_m_s3) {
  if (!(length_m > 0.0)) return 0.0;
  const double reached = std::min(v, std::sqrt(std::max(0.0, a * length_m + 0.5 * (v0 * v0 + v1 * v1))));
  const double peak = std::max({reached, v0, v1});
  const double up_m = (peak * peak - v0 * v0) / (2.0 * a), down_m = (peak * peak - v1 * v1) / (2.0 * a);
  double time_s = (peak - v0) / a + (peak - v1) / a + std::max(0.0, length_m - up_m - down_m) / peak;
  if (jerk_m_s3 > 0.0) {
    // A change of speed by dv takes a / jerk longer, or 2 sqrt(dv / jerk) if a is not reached.
    for (const double dv : {peak - v0, peak - v1}) {
      if (dv > 1e-9) time_s += dv >= a * a / jerk_m_s3 ? 0.5 * a / jerk_m_s3 : std::sqrt(dv / jerk_m_s3) - 0.5 * dv / a;
    }
  }
  return time_s;
}

class Planner {
 public:
  Planner(const std::vector<PathPiece>& pieces, const NcLimits& limits)
      : pieces_(pieces), limits_(limits), stretches_(pieces.size()) {}

  std::vector<double> durations_s() {
    for (std::size_t i = 0; i < pieces_.size(); ++i) limit(i);
    for (std::size_t i = 0; i + 1 < pieces_.size(); ++i) corner(i);
    const std::vector<double> ends = end_velocities();
    std::vector<double> durations(pieces_.size(), 0.0);
    double v0 = 0.0;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const Stretch& s = stretches_[i];
      if (!(pieces_[i].length_m > 0.0)) {
        durations[i] = pieces_[i].standing_s;
        v0 = 0.0;
        continue;
      }
      const double reachable = std::sqrt(v0 * v0 + 2.0 * s.acceleration_m_s2 * s.length_m);
      const double v1 = std::min(ends[i], reachable);
      durations[i] += time_along(s.length_m, v0, v1, s.velocity_m_s, s.acceleration_m_s2, limits_.jerk_m_s3);
      if (s.corner_m > 0.0 && v1 > 0.0) {
        const double corner_s = s.corner_m / v1;
        durations[i] += 0.5 * corner_s;
        durations[i + 1] += 0.5 * corner_s;
      }
      v0 = v1;
    }
    return durations;
  }

 private:
  void limit(std::size_t i) {
    const PathPiece& p = pieces_[i];
    Stretch& s = stretches_[i];
    s.length_m = p.length_m;
    if (!(p.length_m > 0.0)) return;
    if (p.radius_m > 0.0) {  // the direction passes through every axis of the plane
      double a = std::numeric_limits<double>::infinity(), v = a;
      for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(p.begins[axis]) < 1e-9 && std::abs(p.ends[axis]) < 1e-9) continue;
        a = std::min(a, limits_.acceleration_m_s2[axis]);
        v = std::min(v, limits_.velocity_m_s[axis]);
      }
      const double most = std::sqrt(kNormalShare * a * p.radius_m);
      s.velocity_m_s = std::min({p.wanted_m_s, v, most});
      const double normal = s.velocity_m_s * s.velocity_m_s / p.radius_m / a;
      s.acceleration_m_s2 = s.velocity_m_s < most ? a * std::sqrt(std::max(0.25, 1.0 - normal * normal)) : 0.5 * a;
    } else {
      s.velocity_m_s = std::min(p.wanted_m_s, along(limits_.velocity_m_s, p.begins));
      s.acceleration_m_s2 = along(limits_.acceleration_m_s2, p.begins);
    }
  }

  /// The corner from piece i to the next: its speed, and its arc.
  void corner(std::size_t i) {
    const PathPiece &p = pieces_[i], &next = pieces_[i + 1];
    Stretch& s = stretches_[i];
    Stretch& t = stretches_[i + 1];
    if (p.stops || !(p.length_m > 0.0) || !(next.length_m > 0.0) || p.rapid != next.rapid) return;
    double dot = 0.0;
    for (int axis = 0; axis < 3; ++axis) dot += p.ends[axis] * next.begins[axis];
    const double a = std::min(s.acceleration_m_s2, t.acceleration_m_s2), wanted = std::min(s.velocity_m_s, t.velocity_m_s);
    const double kink = std::acos(std::clamp(dot, -1.0, 1.0));  // angle by which the direction turns
    const double jump = 2.0 * std::sin(0.5 * kink);
    const double at_once = jump > 1e-9 ? kKinkShare * a * limits_.cycle_s / jump : std::numeric_limits<double>::infinity();
    if (at_once >= wanted) {
      s.end_m_s = wanted;
      return;
    }
    s.end_m_s = at_once;
    if (p.blend_m == 0.0 || kink > std::numbers::pi - 1e-3 || p.radius_m > 0.0 || next.radius_m > 0.0)
      return;  // arcs exist between lines only
    // The corner's arc turns through its plane: the limits of every axis of the plane apply.
    double turning = a, fastest = wanted;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(p.ends[axis]) < 1e-9 && std::abs(next.begins[axis]) < 1e-9) continue;
      turning = std::min(turning, limits_.acceleration_m_s2[axis]);
      fastest = std::min(fastest, limits_.velocity_m_s[axis]);
    }
    const double theta = 0.5 * (std::numbers::pi - kink);
    const double tolerance_m = p.blend_m < 0.0 ? std::numeric_limits<double>::infinity() : p.blend_m;
    double d_m = std::min(
        {0.5 * p.length_m, 0.5 * next.length_m, s.length_m, tolerance_m * std::cos(theta) / (1.0 - std::sin(theta))});
    double r_m = d_m * std::tan(theta);
    double v = std::sqrt(kNormalShare * turning * r_m);
    if (v > fastest) {
      v = fastest;
      r_m = v * v / (kNormalShare * turning);
      d_m = r_m / std::tan(theta);
    }
    if (v <= at_once) return;
    s.end_m_s = v;
    s.corner_m = r_m * kink;
    s.length_m -= d_m;
    t.length_m -= d_m;
  }

  /// End velocities, lowered so that the path can be stopped at the end of the pieces looked ahead.
  std::vector<double> end_velocities() const {
    const std::size_t n = pieces_.size();
    std::vector<double> ends(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      if (!(pieces_[i].length_m > 0.0) || !(stretches_[i].end_m_s > 0.0)) continue;
      const std::size_t last = std::min(n, i + 1 + kLookAhead);
      double v = 0.0;
      for (std::size_t k = last; k-- > i + 1;) {
        const Stretch& s = stretches_[k];
        if (!(pieces_[k].length_m > 0.0)) {
          v = 0.0;
          continue;
        }
        v = std::min({std::sqrt(v * v + 2.0 * s.acceleration_m_s2 * s.length_m), s.velocity_m_s, stretches_[k - 1].end_m_s});
      }
      ends[i] = std::min(v, stretches_[i].end_m_s);
    }
    return ends;
  }

  const std::vector<PathPiece>& pieces_;
  const NcLimits& limits_;
  std::vector<Stretch> stretches_;
};

}  // namespace

std::vector<double> planned_durations_s(const std::vector<PathPiece>& pieces, const NcLimits& limits) {
  return Planner(pieces, limits).durations_s();
}

}  // namespace driftwright
