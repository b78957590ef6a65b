#include "base/cyclogram.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace driftwright {
namespace {

constexpr double kMostRounding_s = 1e-4;  // an ambient jumps within a millisecond
// Relative to the time: sums of many durations differ slightly from a knot that should equal one of them.
constexpr double kRounding = 1e-9;

/// Rounds a cut to a grid of four times the rounding of the section's end, so that the pieces' durations add up to that end
/// to the last bit.
double on_grid_s(double cut_s, double end_s) {
  const double grid_s = 4.0 * (std::nextafter(end_s, 2.0 * end_s) - end_s);
  return grid_s * std::round(cut_s / grid_s);
}

}  // namespace

double Cyclogram::Column::at(double time_s) const {
  const auto after = std::upper_bound(rows.time_s.begin(), rows.time_s.end(), time_s);
  const auto i = static_cast<std::size_t>(after - rows.time_s.begin());
  return rows.value[i == 0 ? 0 : i - 1];
}

const Cyclogram::Column* Cyclogram::column(std::string_view name_or_header) const {
  for (const Column& c : columns) {
    if (c.name == name_or_header || c.header() == name_or_header) return &c;
  }
  return nullptr;
}

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

double Cyclogram::speed_rpm(double time_s) const {
  double end_s = 0.0;
  for (const Section& s : sections) {
    end_s += s.duration_s;
    if (time_s < end_s) return s.drive.speed_rpm;
  }
  return sections.empty() ? 0.0 : sections.back().drive.speed_rpm;
}

Cyclogram split_at(const Cyclogram& cyclogram, std::vector<double> times_s) {
  std::sort(times_s.begin(), times_s.end());
  Cyclogram split = cyclogram;
  split.sections.clear();
  split.sections.reserve(cyclogram.sections.size() + times_s.size());
  double start_s = 0.0;
  for (const Cyclogram::Section& section : cyclogram.sections) {
    const double end_s = start_s + section.duration_s, rounding_s = std::min(kRounding * end_s, kMostRounding_s);
    double from_s = start_s;
    for (auto t = std::upper_bound(times_s.begin(), times_s.end(), start_s + rounding_s); t != times_s.end(); ++t) {
      if (*t >= end_s - rounding_s) break;
      const double cut_s = on_grid_s(*t, end_s);
      if (cut_s <= from_s + rounding_s) continue;
      split.sections.push_back({cut_s - from_s, section.drive});
      from_s = cut_s;
    }
    split.sections.push_back({from_s == start_s ? section.duration_s : end_s - from_s, section.drive});
    start_s = end_s;
  }
  return split;
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
      for (const Signal& signal : section.drive.signals) {
        auto of_it =
            std::find_if(mean.signals.begin(), mean.signals.end(), [&](const Signal& s) { return s.name == signal.name; });
        if (of_it == mean.signals.end()) of_it = mean.signals.insert(of_it, {signal.name, 0.0});
        of_it->value += share * signal.value;
      }
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
  if (!std::is_sorted(knots.begin(), knots.end())) std::sort(knots.begin(), knots.end());
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  std::vector<LinearStretch> stretches;
  double start_s = 0.0;
  const Drive* last = nullptr;
  for (const Cyclogram::Section& section : cyclogram.sections) {
    const double end_s = start_s + section.duration_s;
    if (!(end_s > start_s)) continue;
    bool changed = !last || section.drive != *last;
    const double rounding_s = std::min(kRounding * end_s, kMostRounding_s);
    for (auto knot = std::upper_bound(knots.begin(), knots.end(), start_s); knot != knots.end(); ++knot) {
      if (*knot >= end_s - rounding_s) break;
      if (*knot <= start_s + rounding_s) continue;
      stretches.push_back({start_s, *knot, section.drive, changed, cyclogram.name, cyclogram.clock_s});
      start_s = *knot;
      changed = false;
    }
    stretches.push_back({start_s, end_s, section.drive, changed, cyclogram.name, cyclogram.clock_s});
    last = &section.drive;
    start_s = end_s;
  }
  return stretches;
}

std::vector<LinearStretch> behind(double time_s, std::vector<LinearStretch> stretches) {
  std::erase_if(stretches, [&](const LinearStretch& s) { return s.end_s <= time_s; });
  if (!stretches.empty() && stretches.front().start_s < time_s) {
    stretches.front().start_s = time_s;
    stretches.front().drive_changed = false;
  }
  return stretches;
}

std::vector<LinearStretch> linear_stretches(const Cyclogram& cyclogram, const TimeSeries& ambient) {
  return linear_stretches(cyclogram, ambient.time_s);
}

}  // namespace driftwright
