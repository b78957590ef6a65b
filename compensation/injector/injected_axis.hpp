#pragma once
// An axis under position control with the pulse injector in its feedback: encoder -> injector -> the control's counter ->
// position loop -> axis -> encoder.

#include <cstdint>
#include <vector>

#include "compensation/injector/direction_watch.hpp"
#include "compensation/injector/encoder.hpp"

namespace driftwright::compensation {

/// Cascade control of a feed drive: P position, PI speed, feed-forward of the commanded speed.
///
///     v_ref = feed_forward v_commanded + position_gain (x_commanded - x_counted)
///     a = speed_gain (v_ref - v) + (speed_gain / speed_reset) integral of (v_ref - v), within +-largest_acceleration
struct Servo {
  double period_s = 1e-3;
  double position_gain_1_s = 40.0;
  double speed_gain_1_s = 400.0;
  double speed_reset_s = 0.02;
  double feed_forward = 1.0;  ///< share of the commanded speed that is fed forward
  double largest_acceleration_um_s2 = 2e6;
};

/// Largest stopping distance [um] from a speed [um/s]: v^2 / (2 largest_acceleration) + v / speed_gain; the second term is
/// the distance if the speed controller brakes without reaching the limit.
[[nodiscard]] double stopping_way_um(const Servo& servo, double speed_um_s);

/// Lower limit of the speed controller's reset time [s] for a stable sampled cascade; infinite if no reset time is stable.
///
/// With T = period, k = speed_gain T, p = position_gain T, s = T / speed_reset and w = z - 1, one cycle of the axis below
/// its largest acceleration has the characteristic polynomial
///
///     w^3 + k [(1 + p)(1 + s) w^2 + (p + s + 2 p s) w + p s] = 0
///
/// Its zeros z lie inside the unit circle (Jury) if and only if
///
///     k (2 + p)(2 + s) < 8   and   1/speed_gain < T + 1/position_gain + speed_reset.
///
/// The second always holds if position_gain <= speed_gain; this function requires that, and solves the first for
/// speed_reset.
[[nodiscard]] double least_speed_reset_s(const Servo& servo);

/// Settings of the injector: limits of what it may do to the control and the axis.
struct InjectorSettings {
  InsertionRules rules = {};
  Counting counting = Counting::kX4;  ///< of the control
  double least_separation_s = 200e-9;
  double largest_count_rate_1_s = 2e6;  ///< of the control: quarter steps per second, independent of how it counts
  double largest_slew_um_s = 20.0;

  /// Smallest time between two edges that satisfies both limits.
  [[nodiscard]] double separation_s() const;
};

/// Times of edges in the simulation are in nanoseconds.
inline constexpr double kTicksPerSecond = 1e9;

/// The limits in ticks. @throws RangeError  when a limit is not positive
[[nodiscard]] InsertionLimits insertion_limits(const InjectorSettings& settings, const Encoder& encoder);

/// Faults during a run.
struct AxisFaults {
  std::int64_t n_jumps = 0;     ///< both lines changed at once: lost edges
  std::int64_t n_too_fast = 0;  ///< edges of the encoder above the control's limit
  std::int64_t n_glitches = 0;  ///< a step and its reverse within the least separation
  bool swapped = false;  ///< the encoder counts against the command, over 20 counts or four times the stopping distance
};

/// The running simulation. Positions are those of the encoder; it does not measure unseen_um().
class InjectedAxis {
 public:
  /// @param swapped  A and B are exchanged between encoder and injector
  InjectedAxis(const Encoder& encoder, const InjectorSettings& injector, const Servo& servo, bool swapped = false);

  /// Correction = the tool's error (actual - commanded) to be compensated, in quarter steps since construction.
  void set_correction(std::int64_t quarters);
  /// Moves the axis to `to_um`, rounded to a count, at this speed, from now on. @throws RangeError when the feed is not
  /// positive
  void command(double to_um, double feed_um_s);
  /// Simulates up to a time. A resting axis without events takes no computing time.
  void run_until(double t_s);

  [[nodiscard]] double time_s() const { return static_cast<double>(t_) / kTicksPerSecond; }
  /// Present position and commanded position, relative to the position at construction.
  [[nodiscard]] double position_um() const { return x_um_ - origin_um_; }
  [[nodiscard]] double commanded_um() const { return commanded_um_; }
  [[nodiscard]] double speed_um_s() const { return v_um_s_; }
  [[nodiscard]] bool at_rest() const { return resting_; }
  [[nodiscard]] std::int64_t count() const { return counter_.count(); }  ///< of the control
  /// Quarter steps at the control's input, by a separate x4 counter.
  [[nodiscard]] std::int64_t control_quarters() const { return every_quarter_.count(); }
  [[nodiscard]] std::int64_t control_jumps() const { return counter_.n_jumps(); }
  [[nodiscard]] const TimedInjector& injector() const { return injector_; }
  [[nodiscard]] AxisFaults faults() const;

 private:
  void tick(std::int64_t to);
  void take_edges();

  Servo servo_;
  double quarter_um_, count_um_;
  bool swapped_;
  EncoderEdges encoder_;
  TimedInjector injector_;
  QuadratureCounter counter_, every_quarter_;
  DirectionWatch watch_;
  std::int64_t t_ = 0;
  double origin_um_, x_um_;
  double v_um_s_ = 0.0, integral_um_s_ = 0.0;
  double commanded_um_ = 0.0, goal_um_ = 0.0, feed_um_s_ = 0.0;
  bool resting_ = true, runs_backward_ = false;
  std::vector<Edge> edges_, out_;
};

}  // namespace driftwright::compensation
