#pragma once
// A touch probe whose signal arrives late at a control that reads positions once per cycle, and the correction of this lag
// (Wang & Jia).
//
// The probe touches, the stylus moves by its pre-travel, and the signal arrives `lag` later. The control latches the time of
// arrival to about a microsecond. It knows the axis position at the ends of its cycles, from a counter that rolls over.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/random.hpp"

namespace driftwright::compensation {

/// Number of increments that the control stores, one per cycle.
inline constexpr std::size_t kKeptIncrements = 50;
/// Largest feed of a reference touch: 30 mm/min [m/s].
inline constexpr double kFastestReference_m_s = 0.5e-3;

/// True data of probe, control and encoder; a calibration does not know the lags.
struct ProbeSystem {
  double cycle_s = 1e-3;
  double latch_s = 1e-6;                                   ///< step of the latched time
  std::array<double, 3> lag_s = {8.3e-3, 9.4e-3, 7.7e-3};  ///< from trigger to arrival, per axis
  double jitter_s = 20e-6;                                 ///< 1 sigma of each arrival
  double pretravel_m = 6e-6;                               ///< motion of the stylus before the probe triggers
  double encoder_step_m = 1e-6;
  int encoder_bits = 32;  ///< of the counter, 2 to 62
};

/// One approach of an axis to a surface.
struct Approach {
  int axis = 0;
  double direction = 1.0;  ///< +1 or -1
  double feed_m_s = 0.01;
  double surface_m = 0.0;
  /// 0: constant speed throughout. Else the axis brakes at this rate, and meets the surface `braking_s` after it began to
  /// brake.
  double deceleration_m_s2 = 0.0;
  double braking_s = 0.0;         ///< < 0: the axis meets the surface before it brakes
  std::int64_t counter_zero = 0;  ///< counts at position 0
};

/// The data of a touch in the control.
struct Touch {
  double position_m = 0.0;           ///< P2, at the end of the cycle of the arrival
  std::vector<double> increments_m;  ///< of the last cycles, the newest last
  double latched_share = 0.0;        ///< dt / T, from the start of the cycle to the arrival
};

/// Simulates a touch. @throws RangeError when the axis stops before the surface or before the probe triggers; for a
/// direction, feed, step or width of
///                     counter that is not valid
[[nodiscard]] Touch touch(const ProbeSystem& system, const Approach& approach, Random& random);

/// P2: the position at the end of the cycle.
[[nodiscard]] double plain_m(const Touch& touch);
/// P3 = P1 + (P2 - P1) dt / T: the position at the arrival of the signal.
[[nodiscard]] double latched_m(const Touch& touch);
/// P2 less the increments of the last `cycles` cycles. @throws RangeError  outside 0 to kKeptIncrements
[[nodiscard]] double undone_m(const Touch& touch, int cycles);
/// The position `lag_cycles` (any number) before the arrival of the signal, from latch and stored increments.
/// @throws RangeError  for a time that the stored increments do not cover
[[nodiscard]] double latched_and_undone_m(const Touch& touch, double lag_cycles);

/// A touch with its commanded direction and feed.
struct FeedTouch {
  double direction = 1.0;
  double feed_m_s = 0.0;
  Touch touch;
};

/// What calibration touches show about an axis, without knowing the true surface.
struct ProbeCalibration {
  double reference_m = 0.0;    ///< surface position from the slow touches, with latch and increments
  int whole_cycles = 0;        ///< N, for undone_m()
  double lag_cycles = 0.0;     ///< for latched_and_undone_m()
  double lag_cycles_sd = 0.0;  ///< its standard error
};

/// Least squares of latched position over feed: the slope is the lag, because pre-travel does not depend on feed. All
/// touches approach the same surface from the same side at constant speed.
/// @throws InputError  for a slow touch above 30 mm/min, no slow touches, or fewer than two faster ones
[[nodiscard]] ProbeCalibration calibrate_probe(double cycle_s, std::span<const FeedTouch> slow,
                                               std::span<const FeedTouch> fast);

}  // namespace driftwright::compensation
