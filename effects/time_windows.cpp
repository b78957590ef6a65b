#include "effects/time_windows.hpp"

#include <fmt/format.h>

namespace driftwright::effects {
namespace {

constexpr double kMostWindows = 10000.0;

}  // namespace

Table windows_table(bool compulsory) {
  return {kWindows, "s", "s", 0.0, 1e9, compulsory, "rows of [begin, end]"};
}

std::vector<Parameter> repeating(std::vector<Parameter> parameters) {
  parameters.push_back({"every", "s", 1.0, 1e9, kNotGiven, "the windows come again after this; requires `until_time`"});
  parameters.push_back({"until_time", "s", 1.0, 1e9, kNotGiven, "when no further turn begins"});
  return parameters;
}

std::vector<std::pair<double, double>> windows_of(const Effect& e) {
  const TimeSeries& rows = e.tables.at(kWindows);
  std::vector<std::pair<double, double>> list;
  for (std::size_t i = 0; i < rows.time_s.size(); ++i) list.emplace_back(rows.time_s[i], rows.value[i]);
  if (!e.has("every")) return list;
  const std::size_t n_written = list.size();
  for (double by_s = e["every"]; list.front().first + by_s < e["until_time"]; by_s += e["every"]) {
    for (std::size_t i = 0; i < n_written; ++i) list.emplace_back(list[i].first + by_s, list[i].second + by_s);
  }
  return list;
}

std::function<double(const Inputs&)> within(std::vector<std::pair<double, double>> windows, double value) {
  return [windows = std::move(windows), value](const Inputs& u) {
    for (const auto& [begin_s, end_s] : windows) {
      if (u.time_s >= begin_s && u.time_s < end_s) return value;
    }
    return 0.0;
  };
}

void add_change_times(const std::vector<std::pair<double, double>>& windows, HeatBalance& balance) {
  for (const auto& [begin_s, end_s] : windows) {
    if (begin_s > 0.0) balance.change_times_s.push_back(begin_s);
    balance.change_times_s.push_back(end_s);
  }
}

void check_windows(const Effect& e, const ConfigMap& in) {
  const TimeSeries& rows = e.tables.at(kWindows);
  for (std::size_t i = 0; i < rows.time_s.size(); ++i) {
    if (!(rows.value[i] > rows.time_s[i])) in.fail(kWindows, "each window [begin, end] must end after it begins");
    if (i > 0 && rows.time_s[i] < rows.value[i - 1]) in.fail(kWindows, "windows must follow each other without overlap");
  }
  if (e.has("every") != e.has("until_time")) in.fail("every", "`every` and `until_time` must be given together");
  if (!e.has("every")) return;
  if (!(e["every"] >= rows.value.back() - rows.time_s.front()))
    in.fail("every", "the next turn would begin before this one ends");
  if (e["until_time"] > kMostWindows * e["every"])
    in.fail("every", fmt::format("at most {:.0f} repetitions are allowed", kMostWindows));
}

Doubt one_window(const DoubtScene::Run& run, Effect window, DoubtedNumber size, double trial, const std::string& law) {
  window.in = run.name;
  window.tables[kWindows] = {{0.25 * run.length_s}, {0.5 * run.length_s}};
  const auto begin = [](std::span<Effect> added, double value) {
    TimeSeries& rows = added[0].tables[kWindows];
    const double length_s = rows.value[0] - rows.time_s[0];
    rows = {{value}, {value + length_s}};
  };
  DoubtedNumber length = doubted("length", "min", run.length_s / 60.0 / 4.0, 1.0, run.length_s / 60.0 / 8.0);
  length.low = 1.0;
  length.high = run.length_s / 60.0;
  length.set = [](std::span<Effect> added, double value) {
    TimeSeries& rows = added[0].tables[kWindows];
    rows.value[0] = rows.time_s[0] + 60.0 * value;
  };
  std::vector<std::vector<double>> grid;
  for (const auto& at : time_grid(run.length_s, 8)) grid.push_back({at[0], 0.0});
  // also windows that last to the end: x of the time counts from the middle, that of the length from an eighth
  for (const auto& at : time_grid(run.length_s, 4))
    grid.push_back({at[0], (0.5 - 0.125) * run.length_s / 60.0 - at[0] / 60.0});
  return {.finding = window.kind->key,
          .where = window.place,
          .law = law + ", in " + run.name,
          .added = {window},
          .numbers = {size, doubted_time("begin", run.length_s, begin), length},
          .trial = trial,
          .grid = grid};
}

}  // namespace driftwright::effects
