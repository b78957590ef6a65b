#include "findings/strategy_section.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "compensation/predictors/formula_predictor.hpp"
#include "findings/cause_words.hpp"
#include "findings/columns.hpp"
#include "findings/iso230_3_section.hpp"
#include "output/drift_model_files.hpp"
#include "output/heat_map.hpp"

namespace driftwright::findings {
namespace {

using namespace compensation;
using output::Datum;
using output::Section;
using output::Table;
using output::Value;

bool is_intact(const Case& c) {
  return c.failed.empty();
}

bool has_failures(const StrategyMatrix& m) {
  return m.settings.fails_at.has_value();
}

/// What the model of the strategies with physics lost when it was made linear; null if nothing.
const LinearisedModel* linearised_of(const StrategyMatrix& m) {
  const std::optional<Physics>& physics = m.settings.strategies.physics;
  return physics && physics->linearised ? &*physics->linearised : nullptr;
}

/// One column of the matrix, with the cases whose worst it shows.
struct StrategyColumn {
  std::string title;
  std::function<bool(const Case&)> counts;
};
std::vector<StrategyColumn> columns(const StrategyMatrix& m) {
  std::vector<StrategyColumn> list;
  for (const std::string& family : families_of(m))
    list.push_back({family, [&m, family](const Case& c) { return is_intact(c) && m.runs[c.run].family == family; }});
  for (const std::string& season : seasons_of(m)) {
    if (!season.empty())
      list.push_back({season, [&m, season](const Case& c) { return is_intact(c) && m.runs[c.run].season == season; }});
  }
  if (has_failures(m)) list.push_back({"sensor failed", [](const Case& c) { return !is_intact(c); }});
  return list;
}

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

bool has_failed(const Case& c) {
  return !is_intact(c);
}

std::string name_of(const JudgedRunOfMachine& r) {
  return r.season.empty() ? r.name : fmt::format("{}, {}", r.name, r.season);
}

/// Replaces a value that is not finite, from a prediction that is missing.
Datum finite(double value) {
  return std::isfinite(value) ? Datum(value) : Datum("no value");
}

/// The worst case per family and season.
Table matrix_table(const StrategyMatrix& m) {
  Table table{
      .key = "largest_residuals",
      .title = fmt::format("Largest |residual| in each family and season; tolerance {:g} µm", m.settings.tolerance_um),
      .columns = {{.key = "strategy", .title = "strategy"}},
      .detail = true};
  const std::vector<StrategyColumn> list = columns(m);
  for (const StrategyColumn& c : list) table.columns.push_back(um_column(c.title, c.title));
  for (const JudgedStrategy& s : m.strategies) {
    std::vector<Datum> row = {s.fitted.name};
    for (const StrategyColumn& c : list) {
      const Worst w = worst_of(s, c.counts);
      row.push_back(w.peak ? Datum(w.peak->after.peak_abs) : Datum());
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table worst_table(const StrategyMatrix& m) {
  Table table{.key = "worst_cases",
              .title = "Worst case of each strategy with all sensors intact",
              .caption =
                  "Ranges are those ISO 230-3 asks of drift, here of what is left: within 60 min, and in all. Without "
                  "fail-safe: of the bare prediction.",
              .columns = {{.key = "strategy", .title = "strategy"},
                          {.key = "run", .title = "run"},
                          um_column("peak_before_um", "peak before"),
                          um_column("peak_left_um", "peak left"),
                          percent_column("removed_percent", "removed"),
                          um_column("rms_left_um", "RMS left"),
                          um_column("peak_without_fail_safe_um", "without fail-safe"),
                          um_column("range_60_min_um", "range in 60 min"),
                          um_column("range_um", "range in all"),
                          um_column("failed_peak_left_um", "peak with failed sensor"),
                          um_column("failed_peak_without_fail_safe_um", "without fail-safe then")},
              .detail = true};
  for (const JudgedStrategy& s : m.strategies) {
    const Worst w = worst_of(s, is_intact), failed = worst_of(s, has_failed);
    if (!w.peak) continue;
    double bare = 0.0, bare_intact = 0.0;
    for (const Case& c : s.cases) {
      double& worst = is_intact(c) ? bare_intact : bare;
      worst = std::max(worst, c.peak_unguarded_um);
    }
    const Case& c = *w.peak;
    table.rows.push_back({s.fitted.name, name_of(m.runs[c.run]), c.before.peak_abs, c.after.peak_abs,
                          100.0 * (1.0 - c.left()), c.after.rmse, finite(bare_intact), c.first_hour_um, c.whole_um,
                          failed.peak ? Datum(failed.peak->after.peak_abs) : Datum(), failed.peak ? finite(bare) : Datum()});
  }
  return table;
}

Table verdicts_table(const StrategyMatrix& m) {
  Table table{.title = "Whether a strategy may go on the machine, and why",
              .columns = {{.title = "strategy"},
                          {.title = "verdict"},
                          {.title = "why"},
                          {.title = "keeps the tolerance in"},
                          {.title = "beaten by"}},
              .detail = true};
  for (const JudgedStrategy& s : m.strategies) {
    if (!s.fitted.is_baseline) table.rows.push_back({s.fitted.name, word(s.safety), s.why, s.limits, s.beaten_by});
  }
  return table;
}

Table false_alarms_table(const StrategyMatrix& m) {
  Table table{.key = "false_alarms",
              .title = "What fail-safes doubted though every sensor was intact",
              .caption = "False alarms, which cost some of the correction.",
              .columns = {{.key = "strategy", .title = "strategy"},
                          {.key = "runs", .title = "runs"},
                          {.key = "first", .title = "first of them"}},
              .detail = true};
  for (const JudgedStrategy& s : m.strategies) {
    int n = 0;
    std::string first;
    for (const Case& c : s.cases) {
      if (!is_intact(c) || c.events.empty()) continue;
      if (n++ == 0) first = fmt::format("{}: {}", m.runs[c.run].name, c.events.front());
    }
    if (n > 0) table.rows.push_back({s.fitted.name, n, first});
  }
  return table;
}

Table fits_table(const StrategyMatrix& m) {
  Table table{.title = "What each fit decided, on the training runs alone",
              .columns = {{.title = "strategy"}, {.title = "decided"}},
              .detail = true};
  for (const JudgedStrategy& s : m.strategies) {
    if (!s.fitted.reason.empty()) table.rows.push_back({s.fitted.name, s.fitted.reason});
  }
  return table;
}

/// The errors of strategies on each left-out part.
Table folds_table(const StrategyMatrix& m) {
  Table table{
      .key = "folds",
      .title = "RMS on parts of the training runs that were left out of the fit",
      .caption = "The choice is made by these alone: of each kind the root mean square, of the kinds the geometric mean.",
      .columns = {{.key = "strategy", .title = "strategy"}},
      .detail = true};
  const auto fullest = std::max_element(m.strategies.begin(), m.strategies.end(), [](const auto& a, const auto& b) {
    return a.fitted.fold_errors.size() < b.fitted.fold_errors.size();
  });
  if (fullest == m.strategies.end()) return table;
  for (const FoldError& e : fullest->fitted.fold_errors) table.columns.push_back(um_column(e.name, e.name));
  for (const JudgedStrategy& s : m.strategies) {
    if (s.fitted.fold_errors.empty()) continue;
    std::vector<Datum> row = {s.fitted.name};
    for (const FoldError& e : s.fitted.fold_errors) row.emplace_back(e.rms_um);
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// ISO 230-3 figures of all recorded displacements and tilts of the judged runs. The test begins in balance: a run that
/// continues others has none.
std::vector<Iso230Run> judged_iso230_3(const StrategyMatrix& m) {
  std::vector<Iso230Run> list;
  for (const JudgedRunOfMachine& r : m.runs) {
    const std::string name = r.season.empty() ? r.name : fmt::format("{}, {}", r.name, r.season);
    list.push_back({name, r.run.n_before == 0 ? iso230_3_figures(r.run.readings)
                                              : Iso230Figures{.running_period_s = 0.0,
                                                              .channels = {},
                                                              .not_available = "the run goes on from what came before it"}});
  }
  return list;
}

/// Displacements and tilts of the runs that strategies do not correct.
std::vector<std::string> other_axes(const StrategyMatrix& m) {
  std::vector<std::string> names;
  const Record& readings = m.runs.front().run.readings;
  for (const Channel& c : readings.channels) {
    const bool is_axis = c.unit == "um" || c.unit == "mm" || c.unit == "urad";
    if (is_axis && &c != readings.find(m.settings.strategies.target)) names.push_back(c.name);
  }
  return names;
}

/// The axis that a verdict is about; "" if no other was recorded.
std::string axis_text(const StrategyMatrix& m) {
  const std::vector<std::string> others = other_axes(m);
  if (others.empty()) return "";
  return fmt::format("Verdicts are of {} alone: no strategy here corrects or judges {}.", m.settings.strategies.target,
                     fmt::join(others, ", "));
}

std::string enough_text(const StrategyMatrix& m, const std::string& family) {
  const JudgedStrategy* s = simplest_enough(m, family);
  if (!s) return fmt::format("none keeps {:g} µm", m.settings.tolerance_um);
  return s->fitted.name;
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

/// Families x seasons; the runs themselves if there is one family without seasons, as with records.
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

/// Families x ways of sensor failure, the worst of all sensors.
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

/// The answer: whether the chosen strategy may go on the machine, and what it leaves.
output::Verdict verdict_of(const StrategyMatrix& m, const JudgedStrategy& chosen) {
  const Worst intact = worst_of(chosen, is_intact), failed = worst_of(chosen, has_failed);
  using Kind = output::Verdict::Kind;
  std::string text;
  if (intact.peak)
    text = fmt::format(
        "{} it leaves at most {:.1f} µm of {}; without correction that run has {:.1f} µm ({}). The tolerance is {:g} µm.",
        failed.peak ? "With all sensors intact" : "In the judged runs", intact.peak->after.peak_abs,
        m.settings.strategies.target, intact.peak->before.peak_abs, name_of(m.runs[intact.peak->run]),
        m.settings.tolerance_um);
  if (failed.peak) text += fmt::format(" With one failed sensor it leaves at most {:.1f} µm.", failed.peak->after.peak_abs);
  if (chosen.safety == Safety::kUnsafe)
    text += fmt::format(" Why it is not safe: {}.", chosen.why);
  else if (chosen.safety == Safety::kWithinLimits)
    text += fmt::format(" It keeps the tolerance in: {}.", fmt::join(chosen.limits, ", "));
  return {.kind = chosen.safety == Safety::kUnsafe ? Kind::kBad
                  : chosen.safety == Safety::kSafe ? Kind::kGood
                                                   : Kind::kNeutral,
          .title = fmt::format("{}: {}{}",
                               chosen.safety == Safety::kUnsafe ? "Not safe to use on the machine"
                               : chosen.safety == Safety::kSafe ? "Safe to use on the machine"
                                                                : "Safe to use within limits",
                               chosen.fitted.name,
                               chosen.safety == Safety::kWithinLimits
                                   ? fmt::format(" ({} of {} cells)", chosen.cells.n_kept(), chosen.cells.n())
                                   : ""),
          .text = text};
}

/// Why this strategy was chosen, and how good the choice was.
std::string choice_text(const StrategyMatrix& m, const JudgedStrategy& chosen) {
  const JudgedStrategy& best = best_in_hindsight(m);
  return fmt::format(
      "{} was chosen by the training runs alone: {}. On the runs it is judged by it leaves {:.3g} µm RMS{}. "
      "{}: {}.",
      chosen.fitted.name, m.choice.why, overall_rms(chosen),
      &best == &chosen ? "; no other leaves less"
                       : fmt::format("; in hindsight '{}' leaves {:.3g} µm RMS", best.fitted.name, overall_rms(best)),
      word(chosen.safety), chosen.why);
}

/// Whether a chiller of the machine switches, which `place` refuses.
bool has_chiller(const scenarios::MachineModel& machine) {
  return std::any_of(machine.effects.begin(), machine.effects.end(), [](const effects::Effect& e) {
    return e.kind->key == "coolant" && e.has("cooling_power") && e["cooling_power"] > 0.0;
  });
}

/// What to do with a chosen strategy that is not safe.
std::vector<std::string> steps_without(const StrategyMatrix& m, const JudgedStrategy& chosen,
                                       const scenarios::Scenario& scenario, const std::string& path) {
  const bool is_kept_intact = std::all_of(chosen.cases.begin(), chosen.cases.end(), [&](const Case& c) {
    return !is_intact(c) || c.after.peak_abs <= m.settings.tolerance_um;
  });
  std::vector<std::string> steps = {
      is_kept_intact
          ? "Do not use it on the machine. It keeps the tolerance with all sensors intact, but not if a sensor fails: the "
            "picture with one failed sensor shows which kind of failure. Mount a further thermometer, or use a strategy "
            "that "
            "the table below calls safe."
          : "Do not use it on the machine. It fails with all sensors intact: the orange cells of its row in the picture "
            "show "
            "in which runs. Add such runs to the training runs and run `driftwright validate` again."};
  if (!scenario.machine) return steps;
  steps.push_back(fmt::format("`driftwright plan-test {}` plans the missing test.", path));
  if (!has_chiller(*scenario.machine))
    steps.back() += fmt::format(" `driftwright place {}` finds places for thermometers.", path);
  return steps;
}

/// The command that shows the correction of a chosen strategy on a run it has not seen.
std::string correction_step(const StrategyMatrix& m, const scenarios::Scenario& scenario, const std::string& path,
                            const std::string& file) {
  const bool is_of_records =
      std::any_of(m.training.begin(), m.training.end(), [](const ObservedRun& r) { return !r.rows.file.empty(); });
  const bool has_axis = scenario.axis_loop && scenario.axis_loop->displacement == m.settings.strategies.target;
  // without `study` of its own the scenario does not say what `compensate` corrects
  const bool has_study = scenario.study && !scenario.study->where.file.empty();
  return fmt::format(
      "The file of this strategy is {}. {}`driftwright compensate {} --model {} --through {}` {}shows its correction on "
      "another {} before you use it on the machine.",
      file, has_study ? "" : "Add the key `study` to the scenario. Then ", path, file,
      is_of_records ? "none --measured ANOTHER_DAY.csv"
      : has_axis    ? "injector"
                    : "none",
      is_of_records ? "(ANOTHER_DAY.csv: a record that was not used here) " : "", is_of_records ? "record" : "cyclogram");
}

/// What to do with the chosen strategy. @param chosen  null: none
std::vector<std::string> steps_with(const StrategyMatrix& m, const JudgedStrategy* chosen,
                                    const scenarios::Scenario& scenario, const output::Provenance& made_by) {
  if (!chosen)
    return {
        "Add training runs, at least two with different cyclograms (`--train`, or `train` under `validation`): parts of "
        "them are left out in turn to choose a strategy."};
  const std::string path = made_by.scenario.empty() ? "SCENARIO" : made_by.scenario;
  if (chosen->safety == Safety::kUnsafe) return steps_without(m, *chosen, scenario, path);
  const std::string file = output::path_in_results(made_by, "models/" + model_file_name(chosen->fitted.name) + ".json");
  return {correction_step(m, scenario, path, file),
          fmt::format("`driftwright follow {}` then corrects beside the running machine{}.", file,
                      chosen->safety == Safety::kSafe ? "" : ", only within the limits above")};
}

/// The matrix in few columns, for people.
Table short_table(const StrategyMatrix& m) {
  Table table{.title = fmt::format("Error of {} that each strategy leaves (fitted to {}, judged on {})",
                                   m.settings.strategies.target, counted(m.training.size(), "run", "runs"),
                                   counted(m.runs.size(), "other", "others")),
              .columns = {{.title = "strategy"}, um_column("", "largest residual")}};
  for (output::Column column : {um_column("", "with a failed sensor"), um_column("", "RMS", 2)})
    table.columns.push_back(column);
  if (!has_failures(m)) table.columns[2].title.clear();
  table.columns.push_back({.title = "verdict"});
  for (const JudgedStrategy& s : m.strategies) {
    const Worst intact = worst_of(s, is_intact), failed = worst_of(s, has_failed);
    table.rows.push_back({s.fitted.name, intact.peak ? Datum(intact.peak->after.peak_abs) : Datum(),
                          failed.peak ? Datum(failed.peak->after.peak_abs) : Datum(), overall_rms(s),
                          s.fitted.is_baseline ? "baseline" : word(s.safety)});
  }
  return table;
}

output::Bars left_bars(const StrategyMatrix& m) {
  output::Bars bars{.caption = "Largest share of the peak that is left in any run, sensors intact [%].", .bars = {}};
  for (const JudgedStrategy& s : m.strategies) {
    const double left = 100.0 * worst_of(s, is_intact).left;
    bars.bars.push_back({s.fitted.name, std::min(left, 200.0), fmt::format("{:.0f} %", left)});
  }
  return bars;
}

/// The drift of the run that is hardest for few sensors, and what strategies predict of it.
void add_course(Section& section, const StrategyMatrix& m) {
  const Contrast c = contrast(m);
  if (!c.simple || !c.chosen) return;
  std::vector<const JudgedStrategy*> shown = {c.simple, c.chosen};
  for (const JudgedStrategy& s : m.strategies) {
    if (s.fitted.name == "observer" && &s != c.chosen) shown.push_back(&s);
  }
  add(section, course(m, c.run, shown));
}

/// The formula in readable form, if there is one.
void add_formula(Section& section, const StrategyMatrix& m) {
  for (const JudgedStrategy& s : m.strategies) {
    if (s.fitted.name != "regression, forward" || !s.fitted.fail_safe) continue;
    const DriftModel* model = as_formula(*s.fitted.predictor);
    if (!model) continue;
    const double interval_um = s.fitted.interval_um.value_or(std::numeric_limits<double>::quiet_NaN());
    section.sections.push_back(
        {.title = "The formula of '" + s.fitted.name + "'",
         .blocks = {output::Preformatted{.text = output::formula_text({*model, *s.fitted.fail_safe, interval_um})}},
         .detail = true});
  }
}

}  // namespace

Section conditions_of(const StrategyMatrix& m) {
  const StrategySettings& how = m.settings.strategies;
  Section section;
  const auto put = [&](const char* key, Datum datum) { add(section, Value{.key = key, .datum = std::move(datum)}); };
  put("target", how.target);
  put("not_judged", other_axes(m));
  put("tolerance_um", m.settings.tolerance_um);
  put("count_from_start", how.count_from_start);
  put("sensors_fail_at", m.settings.fails_at);
  put("reading_K", how.reading_K);
  put("drift_um", how.drift_um);
  const LinearisedModel* linearised = linearised_of(m);
  put("linearised_error_um", linearised ? Datum(linearised->error_um) : Datum());
  if (linearised) {
    Table laws{.key = "linearised_laws", .columns = {{.key = "law"}, {.key = "at_degC"}, {.key = "spread_K"}}};
    for (const solver::LinearisedLaw& l : linearised->laws) laws.rows.push_back({l.name, l.at_K - 273.15, l.spread_K});
    add(section, std::move(laws));
  }
  std::vector<std::string> simulated;
  Table records{.key = "trained_on", .columns = {{.key = "file"}, {.key = "from_s"}, {.key = "until_s"}}};
  for (const ObservedRun& r : m.training) {
    if (r.rows.file.empty())
      simulated.push_back(r.readings.source);
    else
      records.rows.push_back({r.rows.file, r.rows.first_s, r.rows.last_s});
  }
  if (records.rows.empty())
    put("trained_on", simulated);
  else
    add(section, std::move(records));
  return section;
}

Table strategies_table(const StrategyMatrix& m, const std::vector<const JudgedStrategy*>& strategies) {
  const auto for_failures = [&](const char* title) { return has_failures(m) ? title : ""; };
  Table table{.key = "strategies",
              .title = fmt::format("Error of {} that each strategy leaves (fitted to {}, judged on {})",
                                   m.settings.strategies.target, counted(m.training.size(), "run", "runs"),
                                   counted(m.runs.size(), "other", "others")),
              .columns = {{.key = "name", .title = "strategy"},
                          um_column("worst_peak_um", "largest residual"),
                          percent_column("worst_left_percent", "left of the peak"),
                          um_column("failed_sensor_worst_peak_um", for_failures("with a failed sensor")),
                          percent_column("failed_sensor_worst_left_percent", for_failures("left then")),
                          um_column("overall_rms_um", "RMS", 2),
                          um_column("left_out_um", "left out", 2),
                          um_column("interval_95_um", "95 %"),
                          percent_column("covered_percent", "covered"),
                          {.key = "verdict", .title = "verdict"},
                          {.key = "cells_kept", .title = "cells kept"},
                          {.key = "cells", .title = "of cells"},
                          {.key = "model", .title = linearised_of(m) ? "model" : ""},
                          {.key = "beaten_by", .title = "beaten by"},
                          um_column("largest_rms_um", ""),
                          {.key = "baseline"},
                          {.key = "worse_than_nothing"},
                          {.key = "why"},
                          {.key = "keeps_tolerance_in"},
                          {.key = "cells_kept_intact"},
                          {.key = "cells_intact"},
                          {.key = "not_kept"},
                          {.key = "n_not_kept"},
                          {.key = "sensors"},
                          {.key = "decided"}}};
  for (const JudgedStrategy* judged : strategies) {
    const JudgedStrategy& s = *judged;
    const Worst intact = worst_of(s, is_intact), failed = worst_of(s, has_failed);
    const bool base = s.fitted.is_baseline, covers = s.fitted.interval_um.has_value();
    std::vector<Datum> row = {s.fitted.name,
                              intact.peak ? Datum(intact.peak->after.peak_abs) : Datum(),
                              100.0 * intact.left,
                              failed.peak ? Datum(failed.peak->after.peak_abs) : Datum(),
                              failed.peak ? Datum(100.0 * failed.left) : Datum(),
                              overall_rms(s),
                              s.fitted.fold_errors.empty() ? Datum() : Datum(left_out_um(s.fitted)),
                              s.fitted.interval_um,
                              covers ? Datum(100.0 * intact.mean_covered) : Datum(),
                              base ? Datum("baseline") : Datum(word(s.safety)),
                              s.cells.n_kept(),
                              s.cells.n(),
                              s.fitted.model,
                              base ? Datum("") : Datum(s.beaten_by),
                              intact.rms_um,
                              base,
                              base ? Datum() : Datum(s.is_worse_than_nothing),
                              base ? Datum() : Datum(s.why),
                              base ? Datum() : Datum(s.limits),
                              s.cells.n_kept_intact,
                              s.cells.n_intact,
                              s.cells.not_kept,
                              s.cells.n_not_kept,
                              s.fitted.sensors,
                              s.fitted.reason};
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string model_file_name(const std::string& strategy) {
  std::string name;
  for (char ch : strategy) {
    if (std::isalnum(static_cast<unsigned char>(ch))) {
      name += ch;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  return name;
}

namespace {

/// What is left with probings beside each correction; without rows where nothing was probed.
Table probing_table(const StrategyMatrix& m) {
  Table table{.key = "probing"};
  const std::optional<Probing>& probing = m.settings.strategies.probing;
  if (!probing) return table;
  table.title = fmt::format("With a probing every {:.4g} min, noise {:.3g} µm", probing->every_s / 60.0, probing->noise_um);
  table.caption =
      "Sensors intact, rows of all judged runs. The residual is taken for a random process that fades; its deviation and "
      "time constant are those of the parts of the training runs that were left out. 'no correction' is the last probing "
      "alone.";
  table.columns = {
      {.key = "name", .title = "strategy"},
      um_column("overall_rms_um", "RMS without", 2),
      um_column("probed_rms_um", "RMS with", 2),
      um_column("probed_worst_peak_um", "largest residual with"),
      um_column("residual_deviation_um", "deviation", 2),
      {.key = "residual_time_constant_min", .title = "time constant", .unit = "min", .digits = output::significant(3)}};
  for (const JudgedStrategy& s : m.strategies) {
    double squares = 0.0, n = 0.0, peak_um = 0.0;
    for (const Case& c : s.cases) {
      if (!c.failed.empty() || !c.probed) continue;
      squares += c.probed->n * c.probed->rmse * c.probed->rmse;
      n += c.probed->n;
      peak_um = std::max(peak_um, c.probed->peak_abs);
    }
    if (n == 0.0) continue;
    table.rows.push_back({s.fitted.name, overall_rms(s), std::sqrt(squares / n), peak_um, s.fitted.residual->deviation_um,
                          s.fitted.residual->time_constant_s / 60.0});
  }
  return table;
}

Section strategy_numbers(const StrategyMatrix& m, const JudgedStrategy* chosen) {
  Section section{.title = "The numbers"};
  if (chosen) add(section, output::Text{choice_text(m, *chosen)});
  if (const std::string axis = axis_text(m); !axis.empty()) add(section, output::Text{axis});
  if (std::optional<output::Picture> failed = failed_map(m)) add(section, std::move(*failed));
  add(section, short_table(m));
  if (Table probing = probing_table(m); !probing.rows.empty()) add(section, std::move(probing));
  if (const LinearisedModel* linearised = linearised_of(m))
    add(section, output::Text{fmt::format(
                     "Films or heat of this machine follow temperatures. Strategies with physics use a model that is {}, "
                     "about the training runs. In these its drift differs from that of the nonlinear model by at most "
                     "{:.2g} µm; the largest drift is {:.3g} µm.",
                     words_of(*linearised), linearised->error_um, linearised->drift_um)});
  std::vector<std::string> harmful;
  for (const JudgedStrategy& s : m.strategies) {
    if (s.is_worse_than_nothing && !s.fitted.is_baseline) harmful.push_back(s.fitted.name);
  }
  if (!harmful.empty())
    add(section, output::Text{fmt::format("These strategies leave more than no correction in some case: {}.",
                                          fmt::join(harmful, "; "))});
  Table left_out{.key = "left_out",
                 .title = "Left out",
                 .columns = {{.key = "name", .title = "strategy"}, {.key = "why", .title = "why"}}};
  for (const LeftOut& l : m.left_out) left_out.rows.push_back({l.name, l.why});
  add(section, std::move(left_out));
  Table enough{.key = "simplest_enough",
               .title = "In hindsight: the simplest strategy that keeps the tolerance on every run of a family",
               .caption = "In every season, sensors intact. Known once they are judged; it is not what was chosen by.",
               .columns = {{.key = "family", .title = "family"}, {.key = "enough", .title = "enough"}}};
  for (const std::string& family : families_of(m)) enough.rows.push_back({family, enough_text(m, family)});
  add(section, std::move(enough));
  return section;
}

Section strategy_details(const StrategyMatrix& m) {
  Section section{.title = "For experts"};
  std::vector<const JudgedStrategy*> all;
  for (const JudgedStrategy& s : m.strategies) all.push_back(&s);
  Table strategies = strategies_table(m, all);
  strategies.detail = true;
  strategies.title = "All figures of each strategy";
  strategies.caption = fmt::format(
      "Residual: drift less the correction in force, that is the prediction times trust, clamped and slewed. Of each family "
      "the worst run in any season, then of each season{}. Left: the largest share of the peak. RMS: over all rows. Left "
      "out: "
      "RMS on parts of the training runs that it was not fitted to, which is what the choice is made by. 95 %: half width "
      "of "
      "the prediction interval, from parts left out, and the share of rows that it covers. Fitted on {} training runs that "
      "are none of these.",
      has_failures(m) ? ", then with each sensor of the strategy failed half-way in the first season: stuck, open, fallen "
                        "off, drifting by 2 K/h either way, exchanged with the one least like it"
                      : "",
      m.training.size());
  add(section, std::move(strategies));
  for (Table table : {folds_table(m), matrix_table(m), verdicts_table(m), worst_table(m), false_alarms_table(m)})
    add(section, std::move(table));
  add(section, iso230_3_table(judged_iso230_3(m)));
  add(section, fits_table(m));
  section.sections.push_back({.title = "Shares of the peak that are left", .blocks = {left_bars(m)}, .detail = true});
  add_formula(section, m);
  return section;
}

}  // namespace

Section strategy_section(const StrategyMatrix& m, const scenarios::Scenario& scenario, const output::Provenance& made_by) {
  Section section = conditions_of(m);
  section.key = "validation";
  const JudgedStrategy* chosen = chosen_strategy(m);
  if (chosen) {
    add(section, Value{.key = "chosen", .datum = chosen->fitted.name});
    add(section, Value{.key = "why_chosen", .datum = m.choice.why});
    add(section, verdict_of(m, *chosen));
  } else {
    add(section, output::Verdict{.key = "",
                                 .title = "No strategy is chosen",
                                 .text = "Too little can be left out of the training runs to choose one. The picture shows "
                                         "what each strategy leaves on the judged runs."});
  }
  add(section, intact_map(m));
  add_course(section, m);
  section.sections.push_back(output::next_section(steps_with(m, chosen, scenario, made_by)));
  section.sections.push_back(strategy_numbers(m, chosen));
  section.sections.push_back(strategy_details(m));
  return section;
}

Table cases_table(const StrategyMatrix& m) {
  Table table{.key = "cases", .title = "What strategies leave, case by case", .file = "strategies.csv"};
  for (const char* key :
       {"strategy", "family", "season", "run", "failed_sensor", "peak_before_um", "rms_before_um", "peak_left_um",
        "rms_left_um", "mean_left_um", "removed_percent", "range_60min_um", "range_um", "peak_without_fail_safe_um",
        "rms_without_fail_safe_um", "covered_percent", "rows", "harm_um", "doubted"})
    table.columns.push_back({.key = key});
  for (const JudgedStrategy& s : m.strategies) {
    for (const Case& c : s.cases) {
      const JudgedRunOfMachine& r = m.runs[c.run];
      table.rows.push_back({s.fitted.name, r.family, r.season, r.name, c.failed, c.before.peak_abs, c.before.rmse,
                            c.after.peak_abs, c.after.rmse, c.after.mean, 100.0 * (1.0 - c.left()), c.first_hour_um,
                            c.whole_um, c.peak_unguarded_um, c.rms_unguarded_um, 100.0 * c.covered, c.after.n, c.harm_um,
                            c.events});
    }
  }
  return table;
}

}  // namespace driftwright::findings
