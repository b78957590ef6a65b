#include "base/cyclogram.hpp"

#include <algorithm>

namespace driftwright {

double Cyclogram::duration_s() const {
  double sum_s = 0.0;
  for (const Section& s : sections) sum_s += s.duration_s;
  return sum_s;
}

double Cyclogram::speed_rpm(double time_s) const {
  double end_s = 0.0;
  for (const Section& s : sections) {
    end_s += s.duration_s;
    if (time_s < end_s) return s.speed_rpm;
  }
  return sections.empty() ? 0.0 : sections.back().speed_rpm;
}

double TimeSeries::at(double t_s) const {
  if (t_s <= time_s.front()) return value.front();
  if (t_s >= time_s.back()) return value.back();
  const auto after = std::upper_bound(time_s.begin(), time_s.end(), t_s);
  const auto i = static_cast<std::size_t>(after - time_s.begin());
  const double share = (t_s - time_s[i - 1]) / (time_s[i] - time_s[i - 1]);
  return value[i - 1] + share * (value[i] - value[i - 1]);
}

std::vector<LinearStretch> linear_stretches(const Cyclogram& cyclogram, const TimeSeries& hall) {
  std::vector<LinearStretch> stretches;
  double start_s = 0.0, last_speed_rpm = -1.0;
  for (const Cyclogram::Section& section : cyclogram.sections) {
    const double end_s = start_s + section.duration_s;
    if (!(end_s > start_s)) continue;
    std::vector<double> cuts_s = {start_s};
    for (double knot_s : hall.time_s) {
      if (knot_s > start_s && knot_s < end_s) cuts_s.push_back(knot_s);
    }
    cuts_s.push_back(end_s);
    for (std::size_t i = 0; i + 1 < cuts_s.size(); ++i) {
      const bool changed = i == 0 && section.speed_rpm != last_speed_rpm;
      stretches.push_back({cuts_s[i], cuts_s[i + 1], section.speed_rpm, changed});
    }
    last_speed_rpm = section.speed_rpm;
    start_s = end_s;
  }
  return stretches;
}

}  // namespace driftwright
