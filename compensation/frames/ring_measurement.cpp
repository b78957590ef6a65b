#include "compensation/frames/ring_measurement.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/errors.hpp"

namespace driftwright::compensation {
namespace {

struct Span {
  double middle_m, width_m;
};

Span between(const std::optional<double>& high_m, const std::optional<double>& low_m, char axis, double free_diameter_m,
             double tolerance_m) {
  if (!high_m || !low_m || !std::isfinite(*high_m) || !std::isfinite(*low_m))
    throw InputError(fmt::format("a touch of the ring along {}{} is missing", !high_m ? '+' : '-', axis));
  const double width_m = *high_m - *low_m;
  if (!(std::abs(width_m - free_diameter_m) <= tolerance_m)) {
    throw InputError(
        fmt::format("the ring was touched at the wrong side: its touches along {} lie {:+.3f} mm apart, {:.3f} mm are "
                    "expected from inside",
                    axis, 1e3 * width_m, 1e3 * free_diameter_m));
  }
  return {0.5 * (*high_m + *low_m), width_m};
}

}  // namespace

RingCentre ring_centre(std::span<const RingTouches> rounds, double free_diameter_m, double tolerance_m) {
  if (rounds.empty()) throw InputError("the ring is missing: it was not touched");
  const auto n = static_cast<double>(rounds.size());
  RingCentre ring;
  Eigen::Vector2d square = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> centres;
  for (const RingTouches& t : rounds) {
    const Span x = between(t.plus_x_m, t.minus_x_m, 'X', free_diameter_m, tolerance_m);
    const Span y = between(t.plus_y_m, t.minus_y_m, 'Y', free_diameter_m, tolerance_m);
    centres.emplace_back(x.middle_m, y.middle_m);
    ring.centre_m += centres.back() / n;
    ring.diameter_m += 0.5 * (x.width_m + y.width_m) / n;
    ring.out_of_round_m += (x.width_m - y.width_m) / n;
  }
  for (const Eigen::Vector2d& c : centres) square += (c - ring.centre_m).cwiseAbs2();
  if (rounds.size() > 1) ring.scatter_m = std::sqrt(square.maxCoeff() / (n - 1.0));
  return ring;
}

RingCentre measure_ring(const ProbeSystem& system, const RingProbing& probing, const Eigen::Vector2d& centre_m,
                        const ReadTouch& read, Random& random) {
  std::vector<RingTouches> rounds;
  const auto wall = [&](int axis, double direction) {
    const Approach approach{.axis = axis,
                            .direction = direction,
                            .feed_m_s = probing.feed_m_s,
                            .surface_m = centre_m[axis] + 0.5 * direction * probing.free_diameter_m};
    return read(touch(system, approach, random), axis);
  };
  for (int i = 0; i < probing.rounds; ++i) {
    RingTouches t;
    t.plus_x_m = wall(0, 1.0);
    t.minus_x_m = wall(0, -1.0);
    t.plus_y_m = wall(1, 1.0);
    t.minus_y_m = wall(1, -1.0);
    rounds.push_back(t);
  }
  return ring_centre(rounds, probing.free_diameter_m);
}

}  // namespace driftwright::compensation
