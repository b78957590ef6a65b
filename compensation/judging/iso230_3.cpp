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

/// Speed and feeds of a record, without those that have no value: a machine of which nothing is known is not at rest.
std::vector<const Channel*> drives_of(const Record& record) {
  std::vector<const Channel*> drives;
  for (const auto& [name, unit] :
       {std::pair{"speed", "rpm"}, {"feed_x", "mm_min"}, {"feed_y", "mm_min"}, {"feed_z", "mm_min"}}) {
    const Channel* channel = record.find(name);
    if (!channel || channel->unit != unit) continue;
    if (std::any_of(channel->values.begin(), channel->values.end(), [](double v) { return !std::isnan(v); }))
      drives.push_back(channel);
  }
  return drives;
}

/// Displacements and tilts; not the places of axes, which are in mm beside errors in um.
std::vector<const Channel*> distortions_of(const Record& record, bool has_axes) {
  std::vector<const Channel*> all;
  bool has_um = false;
  for (const Channel& c : record.channels) {
    if (!is_displacement_unit(c.unit)) continue;
    all.push_back(&c);
    has_um = has_um || c.unit == "um";
  }
  std::erase_if(all, [&](const Channel* c) {
    const bool is_place = c->name.starts_with("position_") || c->name.starts_with("stroke_");
    return c->unit == "mm" && (is_place || (has_axes && has_um));
  });
  return all;
}

double top_of(const Channel& drive) {
  double top = 0.0;
  for (double v : drive.values) top = std::max(top, std::isnan(v) ? 0.0 : v);
  return top;
}

/// Duration of a drive's running [s], from the first row to the end of the last row in which it moves; 0 if it does not move
/// at the start.
double running_period_s(const Record& record, const Channel& drive) {
  constexpr double kStill = 0.01;  // of the top speed: a drive at rest may be logged with this much
  double running_s = 0.0, now = 0.0;
  const double still = kStill * top_of(drive);
  for (std::size_t i = 0; i + 1 < record.n_samples(); ++i) {
    if (!std::isnan(drive.values[i])) now = drive.values[i];
    if (i == 0 && !(now > still)) return 0.0;
    if (now > still) running_s = record.time_s[i + 1] - record.time_s.front();
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

namespace {

/// Which test a record is, and for how long it runs; `not_available` if it is none.
Iso230Figures test_of(const Record& record, const std::vector<const Channel*>& drives) {
  Iso230Figures figures;
  if (drives.empty()) {
    figures.not_available = "the record has neither a spindle speed (speed_rpm) nor a feed of an axis (feed_x_mm_min)";
    return figures;
  }
  bool moves = false, spindle_moves = false;
  for (const Channel* drive : drives) {
    const bool is_spindle = drive->unit == "rpm";
    if (!(top_of(*drive) > 0.0)) continue;
    moves = true;
    spindle_moves = spindle_moves || is_spindle;
    if (!is_spindle && spindle_moves) continue;  // of a spindle that turns, axes are part of its cycle
    const double running_s = running_period_s(record, *drive);
    if (!(running_s > 0.0)) continue;
    figures.running_period_s = std::max(figures.running_period_s, running_s);
    if (is_spindle) continue;
    figures.test = Iso230Test::kLinearAxis;
    figures.axes += drive->name.back();
  }
  const char* what = figures.test == Iso230Test::kLinearAxis ? "the axis moves" : "the spindle runs";
  if (!moves) {
    figures.test = Iso230Test::kAmbient;
    figures.running_period_s = record.time_s.back() - record.time_s.front();
    what = "the record lasts";
  } else if (!(figures.running_period_s > 0.0)) {
    figures.not_available =
        spindle_moves ? "the spindle does not turn at the start of the record" : "no axis moves at the start of the record";
    return figures;
  }
  if (!(figures.running_period_s >= kHour_s * (1.0 - kRounding)))
    figures.not_available =
        fmt::format("{} for {:.4g} min; the test takes 60 min at least", what, figures.running_period_s / 60.0);
  return figures;
}

}  // namespace

Iso230Figures iso230_3_figures(const Record& record) {
  const std::vector<const Channel*> drives = drives_of(record);
  const bool has_axes =
      std::any_of(record.channels.begin(), record.channels.end(), [](const Channel& c) { return c.unit == "mm_min"; });
  const std::vector<const Channel*> distortions = distortions_of(record, has_axes);
  if (distortions.empty() || record.n_samples() < 2)
    return {.channels = {}, .not_available = "the record has no displacement and no tilt"};
  Iso230Figures figures = test_of(record, drives);
  if (!figures.not_available.empty()) return figures;
  for (const Channel* channel : distortions) {
    const Course course = course_of(record, *channel);
    const double t_s = figures.running_period_s, whole = course.range_until(record.time_s.back() - record.time_s.front());
    const bool runs = figures.test != Iso230Test::kAmbient;
    figures.channels.push_back(
        {.name = channel->name,
         .unit = channel->unit,
         .range_first_60_min = runs ? course.range_until(kHour_s) : kNone,
         .range_running = runs ? course.range_until(t_s) : kNone,
         .at_end_of_running = !runs || course.time_s.empty() ? kNone : course.at(t_s) - course.value.front(),
         .range_whole_record = whole});
  }
  return figures;
}

}  // namespace driftwright::compensation
