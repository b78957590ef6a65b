#include "diagnosis/blunder_drives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace driftwright::diagnosis {
namespace {

constexpr double kFastest_rpm = 3e5;     // no spindle of a machine tool turns faster
constexpr double kSlowest_rpm = 1.0;     // nor slower, at its top speed
constexpr double kAmbientPieces = 60.0;  // of a thermometer's course that is taken for the ambient
constexpr double kRarestRow_s = 1800.0;  // usual range of rows (base/usual_ranges.cpp)

MeasuredRun with_speed(MeasuredRun run, double factor) {
  for (Cyclogram::Section& s : run.cyclogram.sections) s.drive.speed_rpm *= factor;
  set_grid(run);
  return run;
}

/// The drive comes later by `shift_s`, or earlier; what it was before the record is not known, so its first value holds.
MeasuredRun with_drive_later(MeasuredRun run, double shift_s) {
  std::vector<Cyclogram::Section>& sections = run.cyclogram.sections;
  if (shift_s > 0.0) {
    if (!sections.empty()) sections.front().duration_s += shift_s;
  } else {
    double left_s = -shift_s;
    while (sections.size() > 1 && sections.front().duration_s <= left_s) {
      left_s -= sections.front().duration_s;
      sections.erase(sections.begin());
    }
    if (sections.size() > 1) sections.front().duration_s -= left_s;
  }
  for (Cyclogram::Column& c : run.cyclogram.columns) {
    for (double& t : c.rows.time_s) t += shift_s;
  }
  set_grid(run);
  return run;
}

/// Readings as an ambient, averaged over pieces of the record.
TimeSeries ambient_of(const MeasuredRun& run, const MeasuredChannel& c) {
  TimeSeries series;
  const double piece_s = run.time_s.back() / kAmbientPieces;
  double time_s = 0.0, value = 0.0, until_s = piece_s;
  int n = 0;
  for (std::size_t i = 0; i <= run.time_s.size(); ++i) {
    const bool is_end = i == run.time_s.size();
    if (n > 0 && (is_end || run.time_s[i] > until_s)) {
      series.time_s.push_back(time_s / n);
      series.value.push_back(value / n);
      time_s = value = 0.0;
      n = 0;
    }
    if (is_end) break;
    while (run.time_s[i] > until_s) until_s += piece_s;
    if (std::isnan(c.value[static_cast<Eigen::Index>(i)])) continue;
    time_s += run.time_s[i];
    value += c.value[static_cast<Eigen::Index>(i)];
    ++n;
  }
  return series;
}

double top_speed_rpm(const MeasuredRun& run) {
  double top = 0.0;
  for (const Cyclogram::Section& s : run.cyclogram.sections) top = std::max(top, s.drive.speed_rpm);
  return top;
}

std::vector<OtherDrive> other_speeds(const MeasuredRun& run) {
  std::vector<OtherDrive> list;
  const double top_rpm = top_speed_rpm(run);
  struct Unit {
    double factor;
    const char *looks, *map;
  };
  for (const auto& [factor, looks, map] : {Unit{60.0, "revolutions a second (1/s, Hz)", "60"},
                                           {1.0 / 60.0, "60 times too much", "0.0166667"},
                                           {1e3, "thousands of rpm", "1000"},
                                           {30.0 / M_PI, "rad/s", "9.5493"}}) {
    if (!(factor * top_rpm <= kFastest_rpm && factor * top_rpm >= kSlowest_rpm)) continue;
    list.push_back(
        {.run = with_speed(run, factor),
         .what = fmt::format("speed_rpm looks like {}: it reaches {:.4g}, and the simulation agrees if it is {:.4g} rpm",
                             looks, top_rpm, factor * top_rpm),
         .instead = fmt::format("Write `factor: {}` for speed in the map of the file", map)});
  }
  return list;
}

std::vector<OtherDrive> other_clocks(const MeasuredRun& run, double longest_s) {
  std::vector<OtherDrive> list;
  const double length_s = run.time_s.back(), row_s = length_s / static_cast<double>(run.time_s.size() - 1);
  struct Unit {
    double factor;
    const char *times, *looks;
  };
  for (const auto& [factor, times, looks] :
       {Unit{60.0, "60 times too short", "minutes under time_s, or hours under time_min"},
        {1.0 / 60.0, "60 times too long", "seconds under time_min, or minutes under time_h"},
        {3600.0, "3600 times too short", "hours under time_s"},
        {1.0 / 3600.0, "3600 times too long", "seconds under time_h"}}) {
    if (factor > 1.0 && (factor * row_s >= kRarestRow_s || factor * length_s > longest_s)) continue;
    list.push_back({.run = with_clock(run, factor),
                    .what = fmt::format("the times look {}: {}", times, looks),
                    .instead =
                        "Give the column of the time the header of its unit (time_s, time_min, time_h), or write this "
                        "`unit` for `time` in the map of the file",
                    .time_factor = factor});
  }
  for (const double hours : {-2.0, -1.0, 1.0, 2.0}) {
    const double shift_s = 3600.0 * hours;
    if (length_s < 2.0 * std::abs(shift_s)) continue;
    list.push_back(
        {.run = with_drive_later(run, shift_s),
         .what = fmt::format("speed and drives seem to be recorded {:g} h {} than the readings, as by a clock of "
                             "another time zone",
                             std::abs(hours), hours > 0.0 ? "earlier" : "later"),
         .instead = "Bring both to one clock before you join them in one record (`zone` in the map of each file)"});
  }
  return list;
}

std::vector<OtherDrive> other_ambients(const MeasuredRun& run, const std::vector<char>& is_met) {
  std::vector<OtherDrive> list;
  if (!run.has_ambient) return list;
  OtherDrive still{.run = run, .what = {}, .instead = {}, .is_still_air = true};
  still.run.ambient = {{0.0}, {run.ambient.at(0.0)}};
  list.push_back(std::move(still));
  for (std::size_t c = 0; c < run.channels.size(); ++c) {
    const MeasuredChannel& channel = run.channels[c];
    if (channel.unit != "K" || is_met[c] != 0) continue;
    OtherDrive exchanged{.run = run, .what = {}, .instead = {}, .ambient_from = channel.name};
    exchanged.run.ambient = ambient_of(run, channel);
    const Eigen::VectorXd there = channel.value;
    exchanged.run.channels[c].value = ambient_rows(run);
    for (Eigen::Index i = 0; i < there.size(); ++i) {
      if (std::isnan(there[i])) exchanged.run.channels[c].value[i] = there[i];
    }
    exchanged.what =
        fmt::format("ambient and {} look exchanged: the simulation agrees if each is read for the other", channel.name);
    exchanged.instead =
        fmt::format("Exchange the two names in the header of the file or in its map (ambient and {})", channel.name);
    list.push_back(std::move(exchanged));
  }
  return list;
}

}  // namespace

MeasuredRun with_clock(MeasuredRun run, double factor) {
  for (double& t : run.time_s) t *= factor;
  if (run.has_ambient) {  // else it is the scenario's, by its own clock
    for (double& t : run.ambient.time_s) t *= factor;
  }
  for (Cyclogram::Section& s : run.cyclogram.sections) s.duration_s *= factor;
  for (Cyclogram::Column& c : run.cyclogram.columns) {
    for (double& t : c.rows.time_s) t *= factor;
  }
  set_grid(run);
  return run;
}

Eigen::VectorXd ambient_rows(const MeasuredRun& run) {
  Eigen::VectorXd rows(static_cast<Eigen::Index>(run.time_s.size()));
  for (std::size_t i = 0; i < run.time_s.size(); ++i) rows[static_cast<Eigen::Index>(i)] = run.ambient.at(run.time_s[i]);
  return rows;
}

std::vector<OtherDrive> other_drives(const MeasuredRun& run, const std::vector<char>& is_met, double longest_s) {
  std::vector<OtherDrive> all = other_speeds(run);
  for (OtherDrive& o : other_clocks(run, longest_s)) all.push_back(std::move(o));
  for (OtherDrive& o : other_ambients(run, is_met)) all.push_back(std::move(o));
  return all;
}

}  // namespace driftwright::diagnosis
