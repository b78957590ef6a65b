#include "compensation/frames/touch_probe.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/errors.hpp"

namespace driftwright::compensation {
namespace {

/// Distance and time of the axis, counted from where and when it begins to brake.
struct Motion {
  double feed_m_s, deceleration_m_s2;  // 0: never brakes

  [[nodiscard]] double way_m(double t_s) const {
    if (t_s <= 0.0 || deceleration_m_s2 == 0.0) return feed_m_s * t_s;
    const double braked_s = std::min(t_s, feed_m_s / deceleration_m_s2);
    return feed_m_s * braked_s - 0.5 * deceleration_m_s2 * braked_s * braked_s;
  }
  /// Time at which it is `way_m` beyond that place; NaN if it never gets there.
  [[nodiscard]] double time_s(double way_m) const {
    if (way_m <= 0.0 || deceleration_m_s2 == 0.0) return way_m / feed_m_s;
    return (feed_m_s - std::sqrt(feed_m_s * feed_m_s - 2.0 * deceleration_m_s2 * way_m)) / deceleration_m_s2;
  }
};

/// A counter of `bits` bits in two's complement.
std::int64_t rolled(std::int64_t counts, int bits) {
  const std::int64_t span = std::int64_t{1} << bits, half = span / 2;
  std::int64_t in_span = (counts + half) % span;
  if (in_span < 0) in_span += span;
  return in_span - half;
}

void require(bool ok, const char* what) {
  if (!ok) throw RangeError(fmt::format("a touch requires {}", what));
}

}  // namespace

Touch touch(const ProbeSystem& system, const Approach& approach, Random& random) {
  require(approach.axis >= 0 && approach.axis < 3, "axis 0, 1 or 2");
  require(std::abs(approach.direction) == 1.0, "a direction of +1 or -1");
  require(approach.feed_m_s > 0.0 && std::isfinite(approach.feed_m_s), "a feed above 0");
  require(system.encoder_step_m > 0.0 && system.cycle_s > 0.0 && system.latch_s > 0.0, "steps and cycle above 0");
  require(system.encoder_bits >= 2 && system.encoder_bits <= 62, "a counter of 2 to 62 bits");
  const Motion motion{approach.feed_m_s, approach.deceleration_m_s2};
  const bool stops = motion.deceleration_m_s2 > 0.0;
  require(!stops || approach.braking_s < motion.feed_m_s / motion.deceleration_m_s2, "a surface met before the axis stops");
  const double met_m = motion.way_m(stops ? approach.braking_s : 0.0);
  const double trigger_s = motion.time_s(met_m + system.pretravel_m);
  require(std::isfinite(trigger_s), "a way beyond the surface that triggers the probe");
  const double lag_s = system.lag_s[static_cast<std::size_t>(approach.axis)];
  const double arrival_s = trigger_s + std::max(0.0, lag_s + system.jitter_s * random.normal());
  const double since_cycle_s = random.uniform() * system.cycle_s;  // cycles are not synchronised with touches
  const double seen_s = arrival_s + system.cycle_s - since_cycle_s;
  const auto counter = [&](double t_s) {
    const double at_m = approach.surface_m + approach.direction * (motion.way_m(t_s) - met_m);
    const auto counts = static_cast<std::int64_t>(std::floor(at_m / system.encoder_step_m)) + approach.counter_zero;
    return rolled(counts, system.encoder_bits);
  };
  Touch found;
  found.latched_share = std::floor(since_cycle_s / system.latch_s) * system.latch_s / system.cycle_s;
  // The control knows its position from homing and adds increments to it, each taken as the short way around the counter.
  const double first_s = seen_s - static_cast<double>(kKeptIncrements) * system.cycle_s;
  const double first_m = approach.surface_m + approach.direction * (motion.way_m(first_s) - met_m);
  double position = std::floor(first_m / system.encoder_step_m);
  std::int64_t before = counter(first_s);
  for (std::size_t k = 1; k <= kKeptIncrements; ++k) {
    const std::int64_t now = counter(first_s + static_cast<double>(k) * system.cycle_s);
    const auto increment = static_cast<double>(rolled(now - before, system.encoder_bits));
    found.increments_m.push_back(increment * system.encoder_step_m);
    position += increment;
    before = now;
  }
  found.position_m = (position + 0.5) * system.encoder_step_m;  // a counter rounds down
  return found;
}

double plain_m(const Touch& touch) {
  return touch.position_m;
}

double latched_m(const Touch& touch) {
  return latched_and_undone_m(touch, 0.0);
}

double undone_m(const Touch& touch, int cycles) {
  if (cycles < 0 || cycles > static_cast<int>(touch.increments_m.size()))
    throw RangeError(fmt::format("{} cycles cannot be undone; {} are kept", cycles, touch.increments_m.size()));
  double position_m = touch.position_m;
  for (int k = 0; k < cycles; ++k)
    position_m -= touch.increments_m[touch.increments_m.size() - 1 - static_cast<std::size_t>(k)];
  return position_m;
}

double latched_and_undone_m(const Touch& touch, double lag_cycles) {
  const double back = 1.0 - touch.latched_share + lag_cycles;
  if (!(back >= 0.0 && back <= static_cast<double>(touch.increments_m.size()) - 1.0))
    throw RangeError(
        fmt::format("a lag of {:g} cycles cannot be undone; {} are kept", lag_cycles, touch.increments_m.size()));
  const int whole = static_cast<int>(back);
  const double share = back - whole;
  return (1.0 - share) * undone_m(touch, whole) + share * undone_m(touch, whole + 1);
}

ProbeCalibration calibrate_probe(double cycle_s, std::span<const FeedTouch> slow, std::span<const FeedTouch> fast) {
  if (slow.empty()) throw InputError("a calibration requires a reference touch at 30 mm/min or less");
  if (fast.size() < 2) throw InputError("a calibration requires at least two touches faster than the reference");
  for (const FeedTouch& t : slow) {
    if (!(t.feed_m_s <= kFastestReference_m_s * (1.0 + 1e-9)))
      throw InputError(
          fmt::format("the reference touch has a feed of {:g} mm/min; 30 mm/min at most are allowed", 6e4 * t.feed_m_s));
  }
  // position along the approach = surface + feed lag: a line over the feed.
  double n = 0.0, feed = 0.0, feed_2 = 0.0, latched = 0.0, feed_latched = 0.0, plain = 0.0, feed_plain = 0.0;
  const auto each = [&](const auto& work) {
    for (const std::span<const FeedTouch>& touches : {slow, fast}) {
      for (const FeedTouch& t : touches) work(t.feed_m_s, t.direction * latched_m(t.touch), t.direction * plain_m(t.touch));
    }
  };
  each([&](double v_m_s, double latched_at_m, double plain_at_m) {
    n += 1.0;
    feed += v_m_s;
    latched += latched_at_m;
    plain += plain_at_m;
  });
  each([&](double v_m_s, double latched_at_m, double plain_at_m) {
    const double off = v_m_s - feed / n;
    feed_2 += off * off;
    feed_latched += off * (latched_at_m - latched / n);
    feed_plain += off * (plain_at_m - plain / n);
  });
  if (!(feed_2 > 0.0))
    throw InputError("all touches of the calibration have the same feed; the lag shows in their difference");
  ProbeCalibration found;
  const double lag_s = feed_latched / feed_2;
  found.lag_cycles = lag_s / cycle_s;
  found.whole_cycles = static_cast<int>(std::lround(feed_plain / feed_2 / cycle_s));
  double misfit_2 = 0.0;
  each([&](double v_m_s, double latched_at_m, double) {
    const double off_m = latched_at_m - latched / n - lag_s * (v_m_s - feed / n);
    misfit_2 += off_m * off_m;
  });
  found.lag_cycles_sd = std::sqrt(misfit_2 / std::max(1.0, n - 2.0) / feed_2) / cycle_s;
  for (const FeedTouch& t : slow)
    found.reference_m += latched_and_undone_m(t.touch, found.lag_cycles) / static_cast<double>(slow.size());
  return found;
}

}  // namespace driftwright::compensation
