#include "base/cyclogram.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace driftwright {
namespace {

constexpr double kRounding = 1e-9;  // of the time: sums of many durations miss a knot that is meant to be one of them

}  // namespace

double Cyclogram::duration_s() const {
  double sum_s = 0.0;
  for (const Section& s : sections) sum_s += s.duration_s;
  return sum_s;
}

Drive Cyclogram::drive(double time_s) const {
  double end_s = 0.0;
  for (const Section& s : sections) {
    end_s += s.duration_s;
    if (time_s < end_s) return s.drive;
  }
  return sections.empty() ? Drive{} : sections.back().drive;
}

Drive mean_drive(const std::vector<const Cyclogram*>& cyclograms) {
  Drive mean;
  double total_s = 0.0;
  for (const Cyclogram* cyclogram : cyclograms) total_s += cyclogram->duration_s();
  for (const Cyclogram* cyclogram : cyclograms) {
    for (const Cyclogram::Section& section : cyclogram->sections) {
      const double share = section.duration_s / total_s;
      mean.speed_rpm += share * section.drive.speed_rpm;
      for (std::size_t axis = 0; axis < 3; ++axis) mean.feed_m_s[axis] += share * section.drive.feed_m_s[axis];
      mean.cutting_power_W += share * section.drive.cutting_power_W;
    }
  }
  return mean;
}

double TimeSeries::at(double t_s) const {
  if (time_s.empty()) throw std::logic_error("a time series without knots has no value");
  if (t_s <= time_s.front()) return value.front();
  if (t_s >= time_s.back()) return value.back();
  const auto after = std::upper_bound(time_s.begin(), time_s.end(), t_s);
  const auto i = static_cast<std::size_t>(after - time_s.begin());
  const double share = (t_s - time_s[i - 1]) / (time_s[i] - time_s[i - 1]);
  return value[i - 1] + share * (value[i] - value[i - 1]);
}

std::vector<LinearStretch> linear_stretches(const Cyclogram& cyclogram, const std::vector<double>& knots_s) {
  if (std::any_of(knots_s.begin(), knots_s.end(), [](double t_s) { return std::isnan(t_s); }))
    throw std::logic_error("linear_stretches: a knot is NaN");
  std::vector<double> knots = knots_s;
  std::sort(knots.begin(), knots.end());
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  std::vector<LinearStretch> stretches;
  double start_s = 0.0;
  const Drive* last = nullptr;
  for (const Cyclogram::Section& section : cyclogram.sections) {
    const double end_s = start_s + section.duration_s;
    if (!(end_s > start_s)) continue;
    bool changed = !last || section.drive != *last;
    const double rounding_s = kRounding * end_s;
    for (auto knot = std::upper_bound(knots.begin(), knots.end(), start_s); knot != knots.end(); ++knot) {
      if (*knot >= end_s - rounding_s) break;
      if (*knot <= start_s + rounding_s) continue;
      stretches.push_back({start_s, *knot, section.drive, changed, cyclogram.name});
      start_s = *knot;
      changed = false;
    }
    stretches.push_back({start_s, end_s, section.drive, changed, cyclogram.name});
    last = &section.drive;
    start_s = end_s;
  }
  return stretches;
}

std::vector<LinearStretch> linear_stretches(const Cyclogram& cyclogram, const TimeSeries& hall) {
  return linear_stretches(cyclogram, hall.time_s);
}

}  // namespace driftwright
