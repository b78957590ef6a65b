#include "machine/run_record.hpp"

#include <algorithm>

#include "base/quantity.hpp"
#include "base/shown_units.hpp"
#include "effects/effect.hpp"

namespace driftwright::scenarios {
namespace {

/// Adds channels for the drives that the cyclogram uses besides the spindle speed.
void add_feeds_and_cutting_power(Record& record, const Cyclogram& cyclogram) {
  const auto add = [&](const char* name, const char* unit, const auto& of_drive) {
    const auto& sections = cyclogram.sections;
    if (std::none_of(sections.begin(), sections.end(), [&](const auto& s) { return of_drive(s.drive) != 0.0; })) return;
    Channel channel{name, unit, {}};
    for (double t_s : record.time_s) channel.values.push_back(of_drive(cyclogram.drive(t_s)));
    record.channels.push_back(std::move(channel));
  };
  constexpr double kMmMin_per_m_s = 60e3;
  add("feed_x", "mm_min", [](const Drive& d) { return kMmMin_per_m_s * d.feed_m_s[0]; });
  add("feed_y", "mm_min", [](const Drive& d) { return kMmMin_per_m_s * d.feed_m_s[1]; });
  add("feed_z", "mm_min", [](const Drive& d) { return kMmMin_per_m_s * d.feed_m_s[2]; });
  add("cutting_power", "W", [](const Drive& d) { return d.cutting_power_W; });
}

}  // namespace

Record to_record(const solver::Trajectory& run, const solver::Outputs& outputs, const Cyclogram& cyclogram,
                 double reference_K) {
  Record record{.source = cyclogram.name, .time_s = run.time_s, .channels = {}};
  Channel speed{"speed", "rpm", {}};
  for (double t_s : run.time_s) speed.values.push_back(cyclogram.speed_rpm(t_s));
  record.channels.push_back(std::move(speed));
  add_feeds_and_cutting_power(record, cyclogram);
  for (std::size_t i = 0; i < outputs.name.size(); ++i) {
    if (effects::is_mean_output(outputs.name[i])) continue;  // not an instrument
    const auto row = run.outputs.row(static_cast<Eigen::Index>(i));
    Channel channel{outputs.name[i], shown_reading_unit(outputs.unit[i]), {}};
    const double factor = shown_scale(outputs.unit[i]);
    const double offset = outputs.unit[i] == "K" ? reference_K - kZeroCelsius_K : 0.0;
    for (Eigen::Index k = 0; k < row.size(); ++k) channel.values.push_back(factor * row[k] + offset);
    record.channels.push_back(std::move(channel));
  }
  return record;
}

std::vector<double> output_times_s(const Cyclogram& cyclogram, double interval_s, const std::vector<double>& further_s) {
  std::vector<double> times_s;
  const double end_s = cyclogram.duration_s();
  for (int i = 0; i * interval_s < end_s * (1 - 1e-12); ++i) times_s.push_back(i * interval_s);
  for (double t_s : further_s) {
    if (t_s < end_s * (1 - 1e-12)) times_s.push_back(t_s);
  }
  times_s.push_back(end_s);
  std::sort(times_s.begin(), times_s.end());
  const auto same = [](double a, double b) { return b - a <= 1e-9 * b; };  // sums of intervals differ by rounding
  times_s.erase(std::unique(times_s.begin(), times_s.end(), same), times_s.end());
  return times_s;
}

}  // namespace driftwright::scenarios
