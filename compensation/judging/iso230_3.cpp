#include "compensation/judging/iso230_3.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/record_channel.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kRounding = 1e-9;  // of a time: row times are sums of intervals
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool is_distortion(const Channel& channel) {
  return is_displacement_unit(channel.unit);
}

/// Duration of the spindle's running [s], from the first row to the end of the last row in which it turns; 0 if it does not
/// turn at the start.
double running_period_s(const Record& record, const Channel& speed) {
  constexpr double kStill = 0.01;  // of the top speed: a drive at rest may be logged with this much
  double running_s = 0.0, rpm = 0.0, top_rpm = 0.0;
  for (double v : speed.values) top_rpm = std::max(top_rpm, std::isnan(v) ? 0.0 : v);
  const double still_rpm = kStill * top_rpm;
  for (std::size_t i = 0; i + 1 < record.n_samples(); ++i) {
    if (!std::isnan(speed.values[i])) rpm = speed.values[i];
    if (i == 0 && !(rpm > still_rpm)) return 0.0;
    if (rpm > still_rpm) running_s = record.time_s[i + 1] - record.time_s.front();
  }
  return running_s;
}

/// Readings of a channel, missing ones left out.
struct Course {
  std::vector<double> time_s;  ///< from the record's first row
  std::vector<double> value;

  [[nodiscard]] double at(double t_s) const {
    const auto after = std::upper_bound(time_s.begin(), time_s.end(), t_s);
    if (after == time_s.begin()) return kNone;
    const auto i = static_cast<std::size_t>(after - time_s.begin());
    if (i == time_s.size()) return value.back();
    const double share = (t_s - time_s[i - 1]) / (time_s[i] - time_s[i - 1]);
    return value[i - 1] + share * (value[i] - value[i - 1]);
  }

  [[nodiscard]] double range_until(double end_s) const {
    double low = at(end_s), high = low;
    for (std::size_t i = 0; i < time_s.size() && time_s[i] <= end_s; ++i) {
      low = std::min(low, value[i]);
      high = std::max(high, value[i]);
    }
    return high - low;
  }
};

Course course_of(const Record& record, const Channel& channel) {
  Course course;
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    if (std::isnan(channel.values[i])) continue;
    course.time_s.push_back(record.time_s[i] - record.time_s.front());
    course.value.push_back(channel.values[i]);
  }
  return course;
}

}  // namespace

Iso230Figures iso230_3_figures(const Record& record) {
  Iso230Figures figures;
  const Channel* speed = record.find("speed");
  const bool has_distortion = std::any_of(record.channels.begin(), record.channels.end(), is_distortion);
  if (!has_distortion || record.n_samples() < 2) {
    figures.not_available = "the record has no displacement and no tilt";
    return figures;
  }
  if (!speed || speed->unit != "rpm") {
    figures.not_available = "the record has no spindle speed (speed_rpm)";
    return figures;
  }
  figures.running_period_s = running_period_s(record, *speed);
  if (!(figures.running_period_s > 0.0)) {
    figures.not_available = "the spindle does not turn at the start of the record";
    return figures;
  }
  if (!(figures.running_period_s >= kHour_s * (1.0 - kRounding))) {
    figures.not_available =
        fmt::format("the spindle runs for {:.4g} min; the test takes 60 min at least", figures.running_period_s / 60.0);
    return figures;
  }
  for (const Channel& channel : record.channels) {
    if (!is_distortion(channel)) continue;
    const Course course = course_of(record, channel);
    const double t_s = figures.running_period_s;
    figures.channels.push_back({.name = channel.name,
                                .unit = channel.unit,
                                .range_first_60_min = course.range_until(kHour_s),
                                .range_running = course.range_until(t_s),
                                .at_end_of_running = course.time_s.empty() ? kNone : course.at(t_s) - course.value.front(),
                                .range_whole_record = course.range_until(record.time_s.back() - record.time_s.front())});
  }
  return figures;
}

}  // namespace driftwright::compensation
