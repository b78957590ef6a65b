#include "scenarios/reader/record_runs.hpp"

#include <algorithm>
#include <cmath>

#include "base/record_channel.hpp"

namespace driftwright::scenarios {
namespace {

constexpr double kLeastRest_s = 600.0;
constexpr double kStill = 0.01;               // share of the top speed below which the spindle is at rest
constexpr std::size_t kMostRuns = 8;          // most runs, since each strategy is fitted once per run
constexpr std::size_t kFewestRowsOfRun = 20;  // of a run
constexpr double kBack = 0.05, kBack_K = 0.2, kBack_um = 0.5;
constexpr std::size_t kMeanRows = 5;  // rows averaged to reduce noise

/// A stretch in which the drive rests, followed by a restart.
struct Rest {
  double length_s = 0.0;
  std::size_t start = 0;  ///< row at which the drive restarts
};

bool rests(const Drive& drive, double still_rpm) {
  return drive.speed_rpm <= still_rpm && drive.feed_m_s == std::array<double, 3>{} && drive.cutting_power_W == 0.0;
}

/// Rests between two stretches in which the drive does not rest.
std::vector<Rest> rests_of(const MachineRun& run, std::size_t first, std::size_t last) {
  const std::vector<double>& t = run.readings.time_s;
  const double from_s = t[first] - t.front(), until_s = t[last - 1] - t.front();
  double top_rpm = 0.0;
  for (const Cyclogram::Section& s : run.cyclogram.sections) top_rpm = std::max(top_rpm, s.drive.speed_rpm);
  std::vector<Rest> list;
  double start_s = 0.0, rest_s = 0.0;
  bool has_moved = false;
  for (const Cyclogram::Section& section : run.cyclogram.sections) {
    const double end_s = start_s + section.duration_s, length_s = std::min(end_s, until_s) - std::max(start_s, from_s);
    if (length_s > 0.0 && rests(section.drive, kStill * top_rpm)) {
      rest_s += length_s;
    } else if (length_s > 0.0) {
      if (has_moved && rest_s >= kLeastRest_s) {
        const auto row = std::lower_bound(t.begin(), t.end(), t.front() + start_s - 1e-6);
        list.push_back({rest_s, static_cast<std::size_t>(row - t.begin())});
      }
      has_moved = true;
      rest_s = 0.0;
    }
    start_s = end_s;
  }
  return list;
}

/// A channel; a temperature minus the ambient, if that is known.
std::vector<double> over_ambient(const MachineRun& run, const Channel& channel, bool is_temperature) {
  std::vector<double> x = channel.values;
  if (!is_temperature || run.ambient.time_s.empty()) return x;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] -= run.ambient.at(run.readings.time_s[i] - run.readings.time_s.front());
  return x;
}

/// Mean of the values in some rows, without gaps; NaN if there are none.
double mean_of(const std::vector<double>& x, std::size_t first, std::size_t last) {
  double sum = 0.0, n = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    if (std::isnan(x[i])) continue;
    sum += x[i];
    ++n;
  }
  return n > 0.0 ? sum / n : std::nan("");
}

/// Those of the given rows, in rising order, at which the machine is back in balance; in one pass through the record.
std::vector<std::size_t> in_balance(const MachineRun& run, const std::vector<std::size_t>& rows) {
  std::vector<bool> is_back(rows.size(), true);
  for (const Channel& c : run.readings.channels) {
    const bool is_temperature = is_temperature_unit(c.unit);
    if (!is_temperature && c.unit != "um") continue;
    const std::vector<double> x = over_ambient(run, c, is_temperature);
    const double begin = mean_of(x, 0, std::min(kMeanRows, x.size()));
    if (std::isnan(begin)) continue;
    double way = 0.0;
    std::size_t seen = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (; seen < rows[r]; ++seen) {
        if (!std::isnan(x[seen])) way = std::max(way, std::abs(x[seen] - begin));
      }
      if (rows[r] < kMeanRows) continue;
      const double now = mean_of(x, rows[r] - kMeanRows, rows[r]);
      if (std::abs(now - begin) > std::max(kBack * way, is_temperature ? kBack_K : kBack_um)) is_back[r] = false;
    }
  }
  std::vector<std::size_t> result;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (is_back[r]) result.push_back(rows[r]);
  }
  return result;
}

/// @param balanced  rows of the record, in rising order
RunRows run_from(const std::vector<std::size_t>& balanced, std::size_t first, std::size_t last) {
  const auto after = std::upper_bound(balanced.begin(), balanced.end(), first);
  return {after == balanced.begin() ? 0 : *(after - 1), first, last};
}

}  // namespace

std::vector<std::size_t> starts_after_rests(const MachineRun& run, std::size_t first, std::size_t last) {
  std::vector<std::size_t> starts;
  for (const Rest& rest : rests_of(run, first, last)) starts.push_back(rest.start);
  return starts;
}

RunRows whole_run(const MachineRun& run, std::size_t first, std::size_t last) {
  return run_from(in_balance(run, starts_after_rests(run, 0, last)), first, last);
}

std::vector<RunRows> runs_between_rests(const MachineRun& run, std::size_t first, std::size_t last) {
  std::vector<Rest> by_length = rests_of(run, first, last);
  std::stable_sort(by_length.begin(), by_length.end(), [](const Rest& a, const Rest& b) { return a.length_s > b.length_s; });
  std::vector<std::size_t> cuts = {first, last};
  for (const Rest& rest : by_length) {
    if (cuts.size() > kMostRuns) break;
    const bool leaves_rows = std::all_of(cuts.begin(), cuts.end(), [&](std::size_t c) {
      return (c > rest.start ? c - rest.start : rest.start - c) >= kFewestRowsOfRun;
    });
    if (leaves_rows) cuts.push_back(rest.start);
  }
  std::sort(cuts.begin(), cuts.end());
  const std::vector<std::size_t> balanced = in_balance(run, starts_after_rests(run, 0, last));
  std::vector<RunRows> runs;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) runs.push_back(run_from(balanced, cuts[i], cuts[i + 1]));
  return runs;
}

Cyclogram part_of(const Cyclogram& cyclogram, double from_s, double until_s) {
  Cyclogram part = cyclogram;
  part.sections.clear();
  double start_s = 0.0;
  for (const Cyclogram::Section& section : cyclogram.sections) {
    const double end_s = start_s + section.duration_s, length_s = std::min(end_s, until_s) - std::max(start_s, from_s);
    if (length_s > 0.0) part.sections.push_back({length_s, section.drive});
    start_s = end_s;
  }
  return part;
}

TimeSeries part_of(const TimeSeries& series, double from_s, double until_s) {
  if (series.time_s.empty()) return {};
  TimeSeries part{{0.0}, {series.at(from_s)}};
  for (std::size_t i = 0; i < series.time_s.size(); ++i) {
    if (series.time_s[i] <= from_s || series.time_s[i] > until_s) continue;
    part.time_s.push_back(series.time_s[i] - from_s);
    part.value.push_back(series.value[i]);
  }
  return part;
}

}  // namespace driftwright::scenarios
