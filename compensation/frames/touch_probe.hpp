#pragma once
// A touch probe that reports late to a control that looks once a cycle, and how the lag is undone (Wang & Jia).
//
// The probe touches, gives way by its pre-travel, and its signal arrives `lag` later. The control has latched the time of the
// arrival to about a microsecond and knows the axis at the ends of its cycles, from a counter that rolls over.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/random.hpp"

namespace driftwright::compensation {

/// Increments that the control keeps, one a cycle.
inline constexpr std::size_t kKeptIncrements = 50;
/// Fastest feed of a reference touch: 30 mm/min [m/s].
inline constexpr double kFastestReference_m_s = 0.5e-3;

/// Probe, control and encoder as they are; a calibration knows none of the lags.
struct ProbeSystem {
  double cycle_s = 1e-3;
  double latch_s = 1e-6;                                   ///< step of the latched time
  std::array<double, 3> lag_s = {8.3e-3, 9.4e-3, 7.7e-3};  ///< from trigger to arrival, by axis
  double jitter_s = 20e-6;                                 ///< 1 sigma of each arrival
  double pretravel_m = 6e-6;                               ///< the stylus gives way by it before the probe triggers
  double encoder_step_m = 1e-6;
  int encoder_bits = 32;  ///< of the counter, 2 to 62
};

/// One approach of an axis to a surface.
struct Approach {
  int axis = 0;
  double direction = 1.0;  ///< +1 or -1
  double feed_m_s = 0.01;
  double surface_m = 0.0;
  /// 0: at constant speed through it all. Else the axis brakes at this rate, and meets the surface `braking_s` after it began to.
  double deceleration_m_s2 = 0.0;
  double braking_s = 0.0;         ///< < 0: the surface is met before
  std::int64_t counter_zero = 0;  ///< counts at position 0
};

/// What the control has when it hears of a touch.
struct Touch {
  double position_m = 0.0;           ///< P2, at the end of the cycle of the arrival
  std::vector<double> increments_m;  ///< of the last cycles, the newest last
  double latched_share = 0.0;        ///< dt / T, from the cycle's start to the arrival
};

/// @throws RangeError  when the axis stops before the surface, or before the probe triggers; for a direction, feed, step or width of
///                     counter that makes no sense
[[nodiscard]] Touch touch(const ProbeSystem& system, const Approach& approach, Random& random);

/// Position where the axis is seen, P2.
[[nodiscard]] double plain_m(const Touch& touch);
/// P3 = P1 + (P2 - P1) dt / T: where the axis was as the signal arrived.
[[nodiscard]] double latched_m(const Touch& touch);
/// P2 less the increments of the last `cycles` cycles. @throws RangeError  outside 0 to kKeptIncrements
[[nodiscard]] double undone_m(const Touch& touch, int cycles);
/// Where the axis was `lag_cycles` (no whole number) before the signal arrived: latch and real increments.
/// @throws RangeError  for a time that no kept increment covers
[[nodiscard]] double latched_and_undone_m(const Touch& touch, double lag_cycles);

/// A touch with what the control commanded.
struct FeedTouch {
  double direction = 1.0;
  double feed_m_s = 0.0;
  Touch touch;
};

/// What calibration touches tell about an axis; no truth is in it.
struct ProbeCalibration {
  double reference_m = 0.0;    ///< where the slow touches put the surface, latched and undone
  int whole_cycles = 0;        ///< N, for undone_m()
  double lag_cycles = 0.0;     ///< for latched_and_undone_m()
  double lag_cycles_sd = 0.0;  ///< standard error of it
};

/// Least squares of latched position over feed: its slope is the lag, since pre-travel does not grow with feed. All touches approach
/// the same surface from the same side at constant speed.
/// @throws InputError  for a slow touch above 30 mm/min, no slow touches, or fewer than two faster ones
[[nodiscard]] ProbeCalibration calibrate_probe(double cycle_s, std::span<const FeedTouch> slow,
                                               std::span<const FeedTouch> fast);

}  // namespace driftwright::compensation
