#include "findings/strategy_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "compensation/predictors/scored_rows.hpp"
#include "findings/strategy_cases.hpp"
#include "output/heat_map.hpp"

namespace driftwright::findings {

using namespace compensation;

namespace {

/// A column of a picture of the matrix.
struct MapColumn {
  output::HeatMap::Column heading;
  std::function<bool(const Case&)> counts;
};

/// The run on which a regression on few sensors leaves the largest error, compared with the chosen strategy.
struct Contrast {
  const JudgedStrategy *simple = nullptr, *chosen = nullptr;
  std::size_t run = 0;
};
Contrast contrast(const StrategyMatrix& m) {
  Contrast c;
  for (const JudgedStrategy& s : m.strategies) {
    if (s.fitted.name == "regression, grey grade") c.simple = &s;
  }
  c.chosen = chosen_strategy(m);
  if (!c.simple || !c.chosen) return c;
  double most = -1.0;
  for (const Case& k : c.simple->cases) {
    if (is_intact(k) && k.after.peak_abs > most) {
      most = k.after.peak_abs;
      c.run = k.run;
    }
  }
  return c;
}

output::Plot course(const StrategyMatrix& m, std::size_t run, const std::vector<const JudgedStrategy*>& shown) {
  const JudgedRunOfMachine& r = m.runs[run];
  std::vector<double> t_min;
  for (double t_s : r.run.readings.time_s) t_min.push_back(t_s / 60.0);
  const std::string& target = m.settings.strategies.target;
  const Record counted = scored_readings(r.run, target, m.settings.strategies.count_from_start);
  output::Plot plot{
      .title = fmt::format("{}{}: {}, {} and predicted", r.name, r.season.empty() ? "" : ", " + r.season, target,
                           r.season.empty() ? "measured" : "true"),
      .x_label = "time [min]",
      .y_label = target + " [µm]",
      .series = {
          {.label = r.season.empty() ? "measured" : "true", .x = t_min, .y = counted.at(target).values, .width = 3.0}}};
  for (const JudgedStrategy* s : shown)
    plot.series.push_back({.label = s->fitted.name, .x = t_min, .y = live(*s->fitted.predictor, r.run)});
  return plot;
}

/// The remaining error in µm, coloured by the tolerance. @param columns  each with the cases whose worst it shows
output::Picture map_of(const StrategyMatrix& m, const std::string& title, const std::vector<MapColumn>& columns) {
  output::HeatMap map{.columns = {}, .rows = {}, .values = {}, .limit = m.settings.tolerance_um, .unit = "µm"};
  for (const MapColumn& c : columns) map.columns.push_back(c.heading);
  for (const JudgedStrategy& s : m.strategies) {
    std::vector<double> row;
    for (const MapColumn& c : columns) {
      const Worst w = worst_of(s, c.counts);
      row.push_back(w.peak ? w.peak->after.peak_abs : std::nan(""));
    }
    if (std::all_of(row.begin(), row.end(), [](double um) { return std::isnan(um); })) continue;  // no sensor can fail
    map.rows.push_back(s.fitted.name);
    map.values.push_back(std::move(row));
  }
  return {.title = title, .svg = output::draw_heat_map(map)};
}

}  // namespace

output::Picture intact_map(const StrategyMatrix& m) {
  std::vector<MapColumn> columns;
  const std::vector<std::string> families = families_of(m), seasons = seasons_of(m);
  const bool of_runs = families.size() == 1 && seasons.size() == 1 && seasons.front().empty();
  for (std::size_t i = 0; of_runs && i < m.runs.size(); ++i)
    columns.push_back({{families.front(), m.runs[i].name}, [i](const Case& c) { return is_intact(c) && c.run == i; }});
  for (const std::string& family : families) {
    for (const std::string& season : seasons) {
      const auto is_here = [family, season](const JudgedRunOfMachine& r) {
        return r.family == family && r.season == season;
      };
      if (of_runs || std::none_of(m.runs.begin(), m.runs.end(), is_here)) continue;
      columns.push_back({{family, season}, [&m, is_here](const Case& c) { return is_intact(c) && is_here(m.runs[c.run]); }});
    }
  }
  return map_of(m, fmt::format("Largest |residual| of {} in µm, all sensors intact", m.settings.strategies.target), columns);
}

std::optional<output::Picture> failed_map(const StrategyMatrix& m) {
  const auto way_of = [](const Case& c) -> std::string {  // "t05 stuck", "t05 and t11 exchanged"
    return c.failed.ends_with(" exchanged") ? "exchanged" : c.failed.substr(c.failed.find(' ') + 1);
  };
  std::vector<std::string> ways;
  for (const JudgedStrategy& s : m.strategies) {
    for (const Case& c : s.cases) {
      if (!is_intact(c) && std::find(ways.begin(), ways.end(), way_of(c)) == ways.end()) ways.push_back(way_of(c));
    }
  }
  if (ways.empty()) return std::nullopt;
  std::vector<MapColumn> columns;
  for (const std::string& way : ways)
    columns.push_back({{"one sensor failed half-way, the worst of all", way},
                       [way, way_of](const Case& c) { return !is_intact(c) && way_of(c) == way; }});
  return map_of(m, fmt::format("Largest |residual| of {} in µm with one failed sensor", m.settings.strategies.target),
                columns);
}

std::optional<output::Plot> hardest_course(const StrategyMatrix& m) {
  const Contrast c = contrast(m);
  if (!c.simple || !c.chosen) return std::nullopt;
  std::vector<const JudgedStrategy*> shown = {c.simple, c.chosen};
  for (const JudgedStrategy& s : m.strategies) {
    if (s.fitted.name == "observer" && &s != c.chosen) shown.push_back(&s);
  }
  return course(m, c.run, shown);
}

output::Bars left_bars(const StrategyMatrix& m) {
  output::Bars bars{.caption = "Largest share of the peak that is left in any run, sensors intact [%].", .bars = {}};
  for (const JudgedStrategy& s : m.strategies) {
    const double left = 100.0 * worst_of(s, is_intact).left;
    bars.bars.push_back({s.fitted.name, std::min(left, 200.0), fmt::format("{:.0f} %", left)});
  }
  return bars;
}

}  // namespace driftwright::findings
