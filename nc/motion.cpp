#include "nc/motion.hpp"

#include <cmath>

#include "nc/arc.hpp"

namespace driftwright {
namespace {

std::array<double, 3> travel_between(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {std::abs(b[0] - a[0]), std::abs(b[1] - a[1]), std::abs(b[2] - a[2])};
}

double length(const std::array<double, 3>& v) {
  return std::hypot(v[0], v[1], v[2]);
}

}  // namespace

void NcMotion::rapid_to(const std::array<double, 3>& target_m) {
  const std::array<double, 3> travel_m = travel_between(position_m, target_m);
  const double length_m = length(travel_m);
  position_m = target_m;
  if (length_m == 0.0) return;
  if (!rapid_m_s_) throw InputError(where, "a rapid move, but nobody says how fast; state `rapid`, such as 15 m/min");
  moves_.push_back({length_m / *rapid_m_s_, speed_rpm(), travel_m, false});
}

void NcMotion::feed_along(double length_m, const std::array<double, 3>& travel_m) {
  if (!(feed > 0.0)) {
    throw InputError(where, feed_mode == NcFeedMode::InverseTime
                                ? "a feed move without F; with G93 every block of feed motion has an F above zero"
                                : "a feed move without a feed; an F above zero is wanted in this block or after the last "
                                  "G93, G94, G95 before it");
  }
  double duration_s = length_m / feed;
  if (feed_mode == NcFeedMode::InverseTime) duration_s = 1.0 / feed;
  if (feed_mode == NcFeedMode::PerRevolution) {
    if (!(speed_rpm() > 0.0))
      throw InputError(where, "a feed per revolution (G95) of a spindle at rest; M3 or M4 and an S above zero are wanted");
    duration_s = length_m / (feed * speed_rpm() / 60.0);
  }
  if (length_m > 0.0) moves_.push_back({duration_s, speed_rpm(), travel_m, speed_rpm() > 0.0});
}

void NcMotion::feed_to(const std::array<double, 3>& target_m) {
  const std::array<double, 3> travel_m = travel_between(position_m, target_m);
  feed_along(length(travel_m), travel_m);
  position_m = target_m;
}

void NcMotion::arc_to(const std::array<double, 3>& target_m, const std::array<double, 3>& centre_m, int normal,
                      bool clockwise, int turns) {
  ArcPath path;
  try {
    path = arc_path(position_m, target_m, centre_m, normal, clockwise, turns);
  } catch (const RangeError& e) {
    throw InputError(where, e.what());
  }
  feed_along(path.length_m, path.travel_m);
  position_m = target_m;
}

void NcMotion::wait(double duration_s) {
  if (duration_s > 0.0) moves_.push_back({duration_s, speed_rpm(), {0, 0, 0}, false});
}

}  // namespace driftwright
