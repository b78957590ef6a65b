#include "compensation/injector/timed_injector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/errors.hpp"

namespace driftwright::compensation {

TimedInjector::TimedInjector(const InsertionLimits& limits) : limits_(limits) {
  (void)PulseInjector(limits.rules);  // checks the rules
  if (limits.separation < 1 || limits.insertion_interval < 1)
    throw RangeError("separation and interval of insertions must be 1 or more");
}

std::int64_t TimedInjector::next_step() const {
  return burst_ == 0 && held_ == 0 ? kNever : std::max(ready_, last_out_ + limits_.separation);
}

std::int64_t TimedInjector::next_insertion() const {
  const InsertionRules& rules = limits_.rules;
  if (std::abs(target_ - inserted_) < rules.quarters || rules.bypass || frozen_) return kNever;
  if (!encoder_.started() || !encoder_.trusted()) return kNever;
  if (!rules.anywhere && (encoder_.lines() & kLinesAB) != 0) return kNever;
  // Use the time after the last step even if one advance() makes it on its way; otherwise the result would depend on how
  // often it is called.
  const std::int64_t at = std::max({clock_, last_out_, last_insertion_ + limits_.insertion_interval});
  const std::int64_t room = limits_.room();
  if (at + room <= edge_t_ + edge_interval_) return at;
  return std::max(at, edge_t_ + std::max(edge_interval_, room));
}

std::int64_t TimedInjector::next_event() const {
  const std::int64_t step = next_step();
  return step != kNever ? step : next_insertion();
}

void TimedInjector::make_step(std::int64_t t, std::vector<Edge>& out) {
  std::int64_t& source = burst_ != 0 ? burst_ : held_;
  const int direction = source > 0 ? +1 : -1;
  source -= direction;
  out_phase_ += direction;
  last_out_ = t;
  if (&source == &held_ && held_ == 0) {
    longest_wait_ = std::max(longest_wait_, t - held_since_);
    held_since_ = kNever;
  }
  out.push_back({t, static_cast<Lines>(lines_of_phase(out_phase_) | (encoder_.lines() & kLineIndex))});
}

void TimedInjector::advance(std::int64_t t, std::vector<Edge>& out) {
  while (true) {
    if (const std::int64_t step = next_step(); step != kNever) {  // waiting steps go before a new insertion
      if (step > t) break;
      make_step(step, out);
      continue;
    }
    const std::int64_t begin = next_insertion();
    if (begin > t) break;
    const int direction = target_ > inserted_ ? +1 : -1;
    burst_ = direction * limits_.rules.quarters;
    inserted_ += burst_;
    last_insertion_ = ready_ = begin;
    ++n_insertions_;
  }
  clock_ = std::max(clock_, t);
}

void TimedInjector::set_target(std::int64_t t, std::int64_t quarters, std::vector<Edge>& out) {
  advance(t, out);
  target_ = quarters;
}

void TimedInjector::input(const Edge& edge, std::vector<Edge>& out) {
  if (!encoder_.started()) {
    (void)encoder_.step(edge.lines);
    out_phase_ = phase_of(edge.lines);
    clock_ = edge_t_ = last_out_ = edge.t;
    out.push_back(edge);
    return;
  }
  if (limits_.rules.bypass) {
    (void)encoder_.step(edge.lines);
    out.push_back(edge);
    return;
  }
  advance(edge.t - 1, out);  // an edge of the encoder goes before an insertion at the same time
  clock_ = edge.t;
  const bool index_changes = ((encoder_.lines() ^ edge.lines) & kLineIndex) != 0;
  const int steps = encoder_.step(edge.lines);
  if (steps != 0) {
    const std::int64_t interval = edge.t - edge_t_;
    if (edge_direction_ != 0 && interval < limits_.separation)
      (edge_direction_ * steps < 0 ? n_glitches_ : n_too_fast_) += 1;
    edge_t_ = edge.t;
    edge_interval_ = interval;
    edge_direction_ = steps < 0 ? -1 : +1;
    if (held_ == 0) held_since_ = edge.t;
    held_ += steps;
    if (held_ == 0) held_since_ = kNever;  // a reversal has cancelled the waiting steps
    ready_ = edge.t;
  }
  const std::size_t n_before = out.size();
  while (next_step() <= edge.t) make_step(edge.t, out);
  if (index_changes && out.size() == n_before)
    out.push_back({edge.t, static_cast<Lines>(lines_of_phase(out_phase_) | (edge.lines & kLineIndex))});
}

double largest_feed_um_s(double quarter_um, int quarters, double separation_s) {
  return quarter_um / ((quarters + 1) * separation_s);
}

double insertion_rate_um_s(double feed_um_s, double quarter_um, int quarters, double separation_s, double slew_um_s) {
  const double window_s = quarter_um / feed_um_s;
  const double per_window = std::floor((window_s / separation_s - 1.0) / quarters + 1e-9);
  return std::min(slew_um_s, std::max(0.0, per_window) * quarters * feed_um_s / kQuartersPerPeriod);
}

}  // namespace driftwright::compensation
