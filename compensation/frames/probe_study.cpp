#include "compensation/frames/probe_study.hpp"

#include <algorithm>
#include <cmath>

#include "compensation/frames/table_frame.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kSurface_m = 1.234;  // not a multiple of any encoder step
constexpr int kPerFeed = 8;           // calibration touches

ProbeCalibration calibrate(const ProbeStudySettings& s, int axis) {
  Random random(s.seed, 10 + static_cast<std::uint64_t>(axis));
  const auto at_feed = [&](double feed_m_s) {
    const Approach approach{.axis = axis, .feed_m_s = feed_m_s, .surface_m = kSurface_m};
    return FeedTouch{1.0, feed_m_s, touch(s.system, approach, random)};
  };
  std::vector<FeedTouch> slow, fast;
  for (int i = 0; i < kPerFeed; ++i) slow.push_back(at_feed(s.reference_feed_m_s));
  for (double feed_m_s : s.feeds_m_s) {
    for (int i = 0; i < kPerFeed; ++i) fast.push_back(at_feed(feed_m_s));
  }
  return calibrate_probe(s.system.cycle_s, slow, fast);
}

ProbeErrors worst_of(const ProbeStudySettings& s, const ProbeSystem& system, const Approach& first,
                     const ProbeCalibration& calibration, Random& random) {
  ProbeErrors worst;
  const auto larger = [&](double& so_far, double at_m) {
    so_far = std::max(so_far, std::abs(at_m - calibration.reference_m));
  };
  for (int i = 0; i < s.touches; ++i) {
    Approach approach = first;  // the surface is anywhere in the ramp, as long as the probe still triggers
    if (approach.deceleration_m_s2 > 0.0)
      approach.braking_s = random.uniform(-5e-3, 0.6) * approach.feed_m_s / approach.deceleration_m_s2;
    const Touch t = touch(system, approach, random);
    const double by_speed_m = plain_m(t) - calibration.whole_cycles * system.cycle_s * approach.feed_m_s;
    larger(worst.plain_m, plain_m(t));
    larger(worst.latched_m, latched_m(t));
    larger(worst.by_speed_m, by_speed_m);
    larger(worst.whole_m, undone_m(t, calibration.whole_cycles));
    larger(worst.corrected_m, latched_and_undone_m(t, calibration.lag_cycles));
  }
  return worst;
}

/// The counter zero for which the counter rolls over 4 counts before the surface, in the middle of the lag.
std::int64_t rolling_at(const ProbeSystem& system, double surface_m, int bits) {
  const auto at = static_cast<std::int64_t>(std::floor(surface_m / system.encoder_step_m));
  return (std::int64_t{1} << (bits - 1)) - at + 4;
}

std::vector<ProbeRow> rows_of_axis(const ProbeStudySettings& s, int axis, const ProbeCalibration& calibration) {
  std::vector<ProbeRow> rows;
  for (std::size_t f = 0; f < s.feeds_m_s.size(); ++f) {
    Random random(s.seed, 100 + 10 * f + static_cast<std::uint64_t>(axis));
    const Approach constant{.axis = axis, .feed_m_s = s.feeds_m_s[f], .surface_m = kSurface_m};
    const auto add = [&](const char* motion, const ProbeSystem& system, const Approach& approach) {
      rows.push_back({axis, s.feeds_m_s[f], motion, worst_of(s, system, approach, calibration, random)});
    };
    add("constant", s.system, constant);
    Approach braking = constant;
    braking.deceleration_m_s2 = s.deceleration_m_s2;
    add("braking", s.system, braking);
    for (int bits : {16, 32}) {
      ProbeSystem system = s.system;
      system.encoder_bits = bits;
      Approach rolling = constant;
      rolling.counter_zero = rolling_at(system, kSurface_m, bits);
      add(bits == 16 ? "roll-over 16" : "roll-over 32", system, rolling);
    }
  }
  return rows;
}

struct Reading {
  const char* name;
  ReadTouch read;
};

std::vector<ShiftRow> shifts(const ProbeStudySettings& s, const std::array<ProbeCalibration, 3>& calibration) {
  const std::vector<Reading> readings = {
      {"plain", [](const Touch& t, int) { return plain_m(t); }},
      {"N cycles undone",
       [&](const Touch& t, int axis) { return undone_m(t, calibration[static_cast<std::size_t>(axis)].whole_cycles); }},
      {"latch and increments", [&](const Touch& t, int axis) {
         return latched_and_undone_m(t, calibration[static_cast<std::size_t>(axis)].lag_cycles);
       }}};
  const double slow = s.feeds_m_s.front(), quick = s.feeds_m_s.back();
  std::vector<ShiftRow> rows;
  for (bool four : {true, false}) {
    for (const auto& [before, now] : {std::pair{slow, slow}, {quick, quick}, {slow, quick}}) {
      for (const Reading& reading : readings) {
        Random random(s.seed, 1000);
        const auto ring_x_m = [&](double feed_m_s, double at_m) {
          if (!four) return reading.read(touch(s.system, {.feed_m_s = feed_m_s, .surface_m = at_m}, random), 0);
          const RingProbing probing{.feed_m_s = feed_m_s, .free_diameter_m = s.free_diameter_m};
          return measure_ring(s.system, probing, {at_m, 0.0}, reading.read, random).centre_m[0];
        };
        ShiftRow row{
            .touches = four ? "four" : "one", .feed_before_m_s = before, .feed_now_m_s = now, .reading = reading.name};
        for (int i = 0; i < s.touches; ++i) {
          const double half_m = 0.5 * s.ring_distance_m, x1_m = ring_x_m(before, -half_m), x2_m = ring_x_m(before, half_m);
          const TempFrame frame = temp_frame(x1_m, x2_m, ring_x_m(now, -half_m), ring_x_m(now, half_m));
          row.worst_shift_m = std::max(row.worst_shift_m, std::abs(frame.shift_m));
          row.worst_scale = std::max(row.worst_scale, std::abs(frame.scale - 1.0));
          row.rms_shift_m += frame.shift_m * frame.shift_m / s.touches;
        }
        row.rms_shift_m = std::sqrt(row.rms_shift_m);
        rows.push_back(row);
      }
    }
  }
  return rows;
}

}  // namespace

ProbeStudy study_probe(const ProbeStudySettings& settings) {
  ProbeStudy study;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    study.calibration[a] = calibrate(settings, axis);
    const std::vector<ProbeRow> rows = rows_of_axis(settings, axis, study.calibration[a]);
    study.rows.insert(study.rows.end(), rows.begin(), rows.end());
  }
  study.shifts = shifts(settings, study.calibration);
  return study;
}

}  // namespace driftwright::compensation
