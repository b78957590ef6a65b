#include "compensation/injector/injected_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.hpp"

namespace driftwright::compensation {
namespace {

std::int64_t ticks(double t_s) {
  return std::llround(t_s * kTicksPerSecond);
}

Lines exchanged(Lines lines) {
  return static_cast<Lines>((lines & kLineIndex) | ((lines & kLineA) << 1) | ((lines & kLineB) >> 1));
}

double positive(double value, const char* what) {
  if (!(value > 0.0)) throw RangeError(fmt::format("{} {} must be positive", what, value));
  return value;
}

}  // namespace

double stopping_way_um(const Servo& servo, double speed_um_s) {
  const double v_um_s = std::abs(speed_um_s);
  return 0.5 * v_um_s * v_um_s / servo.largest_acceleration_um_s2 + v_um_s / servo.speed_gain_1_s;
}

double least_speed_reset_s(const Servo& servo) {
  const double k = servo.speed_gain_1_s * servo.period_s, p = servo.position_gain_1_s * servo.period_s;
  const double most = 8.0 / (k * (2.0 + p)) - 2.0;  // of period / reset time
  return most > 0.0 ? servo.period_s / most : std::numeric_limits<double>::infinity();
}

double InjectorSettings::separation_s() const {
  return std::max(least_separation_s, 1.0 / positive(largest_count_rate_1_s, "largest count rate [1/s]"));
}

InsertionLimits insertion_limits(const InjectorSettings& settings, const Encoder& encoder) {
  positive(settings.least_separation_s, "least separation [s]");
  const double step_um = settings.rules.quarters * encoder.quarter_um();
  const double interval_s = step_um / positive(settings.largest_slew_um_s, "largest slew [um/s]");
  return {.rules = settings.rules,
          .separation = static_cast<std::int64_t>(std::ceil(settings.separation_s() * kTicksPerSecond - 1e-3)),
          .insertion_interval = std::max<std::int64_t>(1, ticks(interval_s))};
}

InjectedAxis::InjectedAxis(const Encoder& encoder, const InjectorSettings& injector, const Servo& servo, bool swapped)
    : servo_(servo),
      quarter_um_(encoder.quarter_um()),
      count_um_(quarter_um_ * quarters_per_count(injector.counting)),
      swapped_(swapped),
      encoder_(encoder, 0.5 * quarter_um_),
      injector_(insertion_limits(injector, encoder)),
      counter_(0, injector.counting),
      origin_um_(0.5 * quarter_um_),  // in the middle of the quarter where both lines are low
      x_um_(origin_um_) {
  positive(servo.period_s, "servo period [s]");
  positive(servo.speed_reset_s, "reset time of the speed controller [s]");
  injector_.input({0, encoder_.lines()}, out_);
  take_edges();
}

void InjectedAxis::set_correction(std::int64_t quarters) {
  injector_.set_target(t_, quarters, out_);
  take_edges();
}

void InjectedAxis::command(double to_um, double feed_um_s) {
  goal_um_ = std::round(to_um / count_um_) * count_um_;
  feed_um_s_ = positive(feed_um_s, "feed [um/s]");
  resting_ = resting_ && goal_um_ == commanded_um_;
}

void InjectedAxis::take_edges() {
  for (const Edge& edge : out_) {
    counter_.step(edge.lines);
    every_quarter_.step(edge.lines);
  }
  out_.clear();
}

void InjectedAxis::tick(std::int64_t to) {
  const double dt_s = static_cast<double>(to - t_) / kTicksPerSecond;
  const double way_um = goal_um_ - commanded_um_;
  const double command_step_um = std::clamp(way_um, -feed_um_s_ * dt_s, feed_um_s_ * dt_s);
  commanded_um_ = command_step_um == way_um ? goal_um_ : commanded_um_ + command_step_um;
  const double counted_um = static_cast<double>(counter_.count()) * count_um_;
  const double error_um = commanded_um_ - counted_um;
  const double v_ref_um_s = servo_.feed_forward * command_step_um / dt_s + servo_.position_gain_1_s * error_um;
  const double lag_um_s = v_ref_um_s - v_um_s_;
  const double step_um_s = lag_um_s * dt_s / servo_.speed_reset_s;
  const double wanted_um_s2 = servo_.speed_gain_1_s * (lag_um_s + integral_um_s_ + step_um_s);
  const double a_um_s2 = std::clamp(wanted_um_s2, -servo_.largest_acceleration_um_s2, servo_.largest_acceleration_um_s2);
  if (a_um_s2 == wanted_um_s2) integral_um_s_ += step_um_s;  // anti-windup: no integration at the limit
  const double watch_um = std::max(20.0 * count_um_, 4.0 * stopping_way_um(servo_, v_um_s_));
  v_um_s_ += a_um_s2 * dt_s;
  x_um_ += v_um_s_ * dt_s;

  edges_.clear();
  encoder_.move(t_, to, x_um_, edges_);
  const std::int64_t before = injector_.encoder().count();
  for (Edge& edge : edges_) {
    if (swapped_) edge.lines = exchanged(edge.lines);
    injector_.input(edge, out_);
  }
  injector_.advance(to, out_);
  take_edges();
  t_ = to;
  const double counted_way_um = static_cast<double>(injector_.encoder().count() - before) * quarter_um_;
  if (watch_.step(v_ref_um_s * dt_s, counted_way_um, watch_um)) {
    injector_.freeze();
    runs_backward_ = true;
  }
  // Below this speed the next tick of the control is equal to this one, so the axis is at rest.
  constexpr double kRest_um_s = 1e-3;
  const bool still = std::abs(v_um_s_) < kRest_um_s && std::abs(integral_um_s_) < kRest_um_s;
  const bool agrees = static_cast<double>(counter_.count()) * count_um_ == commanded_um_ && commanded_um_ == goal_um_;
  resting_ = still && agrees && injector_.waiting() == 0;
  if (resting_) v_um_s_ = integral_um_s_ = 0.0;
}

void InjectedAxis::run_until(double t_s) {
  const std::int64_t end = ticks(t_s);
  const std::int64_t period = ticks(servo_.period_s);
  while (t_ < end) {
    if (resting_) {  // nothing changes until the injector acts
      const std::int64_t next = injector_.next_event();
      if (next > end) {
        injector_.advance(end, out_);
        t_ = end;
        return;
      }
      t_ = std::max(t_, next / period * period);
      resting_ = false;
    }
    tick(std::min(end, (t_ / period + 1) * period));
  }
}

AxisFaults InjectedAxis::faults() const {
  return {injector_.encoder().n_jumps(), injector_.n_too_fast(), injector_.n_glitches(), runs_backward_};
}

}  // namespace driftwright::compensation
