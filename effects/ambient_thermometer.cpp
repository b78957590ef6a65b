#include "effects/ambient_thermometer.hpp"

#include <algorithm>
#include <cmath>

#include "base/series_in_order.hpp"

namespace driftwright::effects {
namespace {

// Knots after the start of a section, in lags: a straight line between two of them is off by at most 1 % of the change.
constexpr double kBehindAChange[] = {0.2, 0.45, 0.75, 1.1, 1.5, 2.0, 2.7, 3.7, 5.0};
constexpr double kSmallest = 0.01;  // distance from the settled share up to which knots are added

}  // namespace

TimeSeries of_late_clock(const TimeSeries& recorded, double late_s) {
  if (late_s == 0.0) return recorded;
  TimeSeries moved{{0.0}, {recorded.at(late_s)}};
  for (std::size_t i = 0; i < recorded.time_s.size(); ++i) {
    const double t_s = recorded.time_s[i] - late_s;
    if (t_s <= 0.0) continue;
    moved.time_s.push_back(t_s);
    moved.value.push_back(recorded.value[i]);
  }
  return moved;
}

TimeSeries of_slow_thermometer(const TimeSeries& recorded, double lag_s) {
  if (lag_s == 0.0) return recorded;
  const double half_s = 0.25 * lag_s;
  std::vector<double> knots = recorded.time_s;
  const auto bend_between = [&](double t_s, double from_s, double until_s) {
    if (t_s > from_s && t_s < until_s) knots.push_back(t_s);
  };
  for (std::size_t i = 0; i + 1 < recorded.time_s.size(); ++i) {  // between distant rows the slope changes
    const double from_s = recorded.time_s[i], until_s = recorded.time_s[i + 1];
    if (!(until_s - from_s > half_s)) continue;
    bend_between(from_s + half_s, from_s, until_s);
    bend_between(until_s - half_s, from_s, until_s);
  }
  std::sort(knots.begin(), knots.end());
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  TimeSeries ahead;
  SeriesInOrder at_K(recorded), before_K(recorded), after_K(recorded);
  for (const double t_s : knots) {
    const double from_s = std::max(knots.front(), t_s - half_s), until_s = std::min(knots.back(), t_s + half_s);
    const double slope_K_s = until_s > from_s ? (after_K.at(until_s) - before_K.at(from_s)) / (until_s - from_s) : 0.0;
    ahead.time_s.push_back(t_s);
    ahead.value.push_back(at_K.at(t_s) + lag_s * slope_K_s);
  }
  return ahead;
}

TimeSeries warmed_with_speed(const TimeSeries& recorded, const Cyclogram& cyclogram, double size_K, double at_speed_rpm,
                             double lag_s) {
  // the settled share of each section and the share reached at its start
  TimeSeries share{{0.0}, {0.0}};
  double start_s = 0.0, reached = 0.0;
  for (const Cyclogram::Section& section : cyclogram.sections) {
    const double settled = std::abs(section.drive.speed_rpm) / at_speed_rpm, end_s = start_s + section.duration_s;
    const auto at = [&](double t_s) { return settled + (reached - settled) * std::exp(-(t_s - start_s) / lag_s); };
    if (std::abs(settled - reached) > kSmallest) {
      for (const double lags : kBehindAChange) {
        const double t_s = start_s + lags * lag_s;
        if (t_s >= end_s) break;
        share.time_s.push_back(t_s);
        share.value.push_back(at(t_s));
      }
    }
    reached = at(end_s);
    if (end_s > share.time_s.back()) {
      share.time_s.push_back(end_s);
      share.value.push_back(reached);
    }
    start_s = end_s;
  }
  std::vector<double> knots;
  std::set_union(recorded.time_s.begin(), recorded.time_s.end(), share.time_s.begin(), share.time_s.end(),
                 std::back_inserter(knots));
  TimeSeries warmed;
  SeriesInOrder ambient_K(recorded), of_settled(share);
  for (const double t_s : knots) {
    warmed.time_s.push_back(t_s);
    warmed.value.push_back(ambient_K.at(t_s) + size_K * of_settled.at(t_s));
  }
  return warmed;
}

}  // namespace driftwright::effects
