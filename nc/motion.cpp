#include "nc/motion.hpp"

#include <algorithm>
#include <cmath>

#include "nc/arc.hpp"

namespace driftwright {
namespace {

std::array<double, 3> travel_between(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {std::abs(b[0] - a[0]), std::abs(b[1] - a[1]), std::abs(b[2] - a[2])};
}

/// A straight piece between two points.
PathPiece straight(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  PathPiece piece;
  const double length_m = std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
  for (int axis = 0; axis < 3 && length_m > 0.0; ++axis)
    piece.begins[axis] = piece.ends[axis] = (b[axis] - a[axis]) / length_m;
  return piece;
}

double length(const std::array<double, 3>& v) {
  return std::hypot(v[0], v[1], v[2]);
}

}  // namespace

void NcDemand::take_position(int axis, double x_m) {
  low_m[axis] = std::min(low_m[axis], x_m);
  high_m[axis] = std::max(high_m[axis], x_m);
}

void NcMotion::rapid_to(const std::array<double, 3>& target_m) {
  const std::array<double, 3> travel_m = travel_between(position_m, target_m);
  const double length_m = length(travel_m);
  PathPiece piece = straight(position_m, target_m);
  piece.rapid = true;
  begin_move();
  end_move(target_m, travel_m);
  if (length_m == 0.0) return;
  if (!rapid_m_s_) throw InputError(where, "the speed of rapid moves is missing; state `rapid`, such as 15 m/min");
  piece.length_m = length_m;
  note({length_m / *rapid_m_s_, speed_rpm(), travel_m, false}, piece);
}

void NcMotion::begin_move() {
  for (int axis = 0; axis < 3; ++axis) shift_m_[axis] += position_m[axis] - last_m_[axis];
}

void NcMotion::end_move(const std::array<double, 3>& target_m, const std::array<double, 3>& travel_m) {
  position_m = last_m_ = target_m;
  for (int axis = 0; axis < 3; ++axis) {
    if (travel_m[axis] > 0.0) demand.take_position(axis, reached_m(axis));
  }
}

void NcMotion::note(const NcMove& move, PathPiece piece) {
  piece.blend_m = blend_m;
  demand.speed_rpm = std::max(demand.speed_rpm, move.speed_rpm);
  if (piece.length_m > 0.0) {
    piece.wanted_m_s = piece.length_m / move.duration_s;
    if (!piece.rapid) demand.feed_m_s = std::max(demand.feed_m_s, piece.wanted_m_s);
  } else {
    piece.standing_s = move.duration_s;
    stop();
  }
  moves_.push_back(move);
  path_.push_back(piece);
}

void NcMotion::stop() {
  if (!path_.empty()) path_.back().stops = true;
}

void NcMotion::feed_along(double length_m, const std::array<double, 3>& travel_m, PathPiece piece) {
  if (!(feed > 0.0)) {
    throw InputError(
        where,
        feed_mode == NcFeedMode::InverseTime
            ? "the feed move has no F; with G93 every block of feed motion must have an F above zero"
            : "the feed move has no feed; write an F above zero in this block or after the last G93, G94, G95 before it");
  }
  double duration_s = length_m / feed;
  if (feed_mode == NcFeedMode::InverseTime) duration_s = 1.0 / feed;
  if (feed_mode == NcFeedMode::PerRevolution) {
    if (!(speed_rpm() > 0.0))
      throw InputError(where,
                       "the feed is per revolution (G95), but the spindle is at rest; write M3 or M4 and an S above zero");
    duration_s = length_m / (feed * speed_rpm() / 60.0);
  }
  piece.length_m = length_m;
  if (length_m > 0.0) note({duration_s, speed_rpm(), travel_m, speed_rpm() > 0.0}, piece);
}

void NcMotion::feed_to(const std::array<double, 3>& target_m) {
  const std::array<double, 3> travel_m = travel_between(position_m, target_m);
  feed_along(length(travel_m), travel_m, straight(position_m, target_m));
  begin_move();
  end_move(target_m, travel_m);
}

void NcMotion::arc_to(const std::array<double, 3>& target_m, const std::array<double, 3>& centre_m, int normal,
                      bool clockwise, int turns, double rounding_m) {
  ArcPath path;
  try {
    path = arc_path(position_m, target_m, centre_m, normal, clockwise, turns, rounding_m);
  } catch (const RangeError& e) {
    throw InputError(where, e.what());
  }
  PathPiece piece;
  piece.begins = path.begins;
  piece.ends = path.ends;
  const double level = 1.0 - path.begins[normal] * path.begins[normal];  // share in the plane, squared
  piece.radius_m = path.radius_m / std::max(level, 1e-12);
  feed_along(path.length_m, path.travel_m, piece);
  begin_move();
  for (int axis = 0; axis < 3; ++axis) {
    if (!(path.travel_m[axis] > 0.0)) continue;
    demand.take_position(axis, path.low_m[axis] - shift_m_[axis]);
    demand.take_position(axis, path.high_m[axis] - shift_m_[axis]);
  }
  end_move(target_m, path.travel_m);
}

void NcMotion::wait(double duration_s) {
  if (duration_s > 0.0) note({duration_s, speed_rpm(), {0, 0, 0}, false}, {});
}

}  // namespace driftwright
