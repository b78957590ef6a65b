#include "app/strategy_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/iso230_3_report.hpp"
#include "base/csv_row.hpp"
#include "compensation/control/control_files.hpp"
#include "compensation/predictors/formula_predictor.hpp"
#include "output/drift_model_c.hpp"
#include "output/drift_model_files.hpp"
#include "output/predictor_file.hpp"

namespace driftwright::app {
namespace {

using namespace compensation;
using Json = nlohmann::ordered_json;

const char* word(compensation::Safety safety) {
  return safety == compensation::Safety::kSafe           ? "safe to deploy"
         : safety == compensation::Safety::kWithinLimits ? "safe within limits"
                                                         : "unsafe";
}

std::string um(double x) {
  return std::isfinite(x) ? fmt::format("{:.1f}", x) : "-";
}
std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.0f}", 100.0 * share) : "-";
}

bool is_intact(const compensation::Case& c) {
  return c.failed.empty();
}

/// A strategy that is a formula, as text and C have it.
std::optional<output::DeployedModel> formula_of(const compensation::JudgedStrategy& s) {
  const DriftModel* model = as_formula(*s.fitted.predictor);
  if (!model || !s.fitted.fail_safe) return std::nullopt;
  return output::DeployedModel{*model, *s.fitted.fail_safe,
                               s.fitted.interval_um.value_or(std::numeric_limits<double>::quiet_NaN())};
}

bool has_failures(const compensation::StrategyMatrix& m) {
  return m.settings.fails_at.has_value();
}

/// One column of the matrix: which cases it is the worst of.
struct Column {
  std::string title;
  std::function<bool(const compensation::Case&)> counts;
};
std::vector<Column> columns(const compensation::StrategyMatrix& m) {
  std::vector<Column> list;
  for (const std::string& family : compensation::families_of(m))
    list.push_back(
        {family, [&m, family](const compensation::Case& c) { return is_intact(c) && m.runs[c.run].family == family; }});
  for (const std::string& season : compensation::seasons_of(m)) {
    if (!season.empty())
      list.push_back(
          {season, [&m, season](const compensation::Case& c) { return is_intact(c) && m.runs[c.run].season == season; }});
  }
  if (has_failures(m)) list.push_back({"sensor failed", [](const compensation::Case& c) { return !is_intact(c); }});
  return list;
}

/// The run on which a regression on few sensors leaves most compared with the observer (or, without one, with the best strategy).
struct Contrast {
  const compensation::JudgedStrategy *simple = nullptr, *best = nullptr;
  std::size_t run = 0;
};
Contrast contrast(const compensation::StrategyMatrix& m) {
  Contrast c;
  for (const compensation::JudgedStrategy& s : m.strategies) {
    if (s.fitted.name == "regression, grey grade") c.simple = &s;
  }
  c.best = compensation::best_strategy(m);
  if (!c.simple || !c.best) return c;
  double most = -1.0;
  for (const compensation::Case& k : c.simple->cases) {
    if (is_intact(k) && k.after.peak_abs > most) {
      most = k.after.peak_abs;
      c.run = k.run;
    }
  }
  return c;
}

output::Plot course(const compensation::StrategyMatrix& m, std::size_t run,
                    const std::vector<const compensation::JudgedStrategy*>& shown) {
  const compensation::JudgedRunOfMachine& r = m.runs[run];
  std::vector<double> t_min;
  for (double t_s : r.run.readings.time_s) t_min.push_back(t_s / 60.0);
  const std::string& target = m.settings.strategies.target;
  const Record counted = scored_readings(r.run, target, m.settings.strategies.count_from_start);
  output::Plot plot{
      .title =
          fmt::format("{}{}: {} and what strategies take it for", r.name, r.season.empty() ? "" : ", " + r.season, target),
      .x_label = "time [min]",
      .y_label = target + " [um]",
      .series = {
          {.label = r.season.empty() ? "measured" : "true", .x = t_min, .y = counted.at(target).values, .width = 3.0}}};
  for (const compensation::JudgedStrategy* s : shown)
    plot.series.push_back({.label = s->fitted.name, .x = t_min, .y = live(*s->fitted.predictor, r.run)});
  return plot;
}

output::Table matrix_table(const compensation::StrategyMatrix& m) {
  output::Table table{.caption = fmt::format("Largest |residual| [um]; tolerance {:g} um.", m.settings.tolerance_um),
                      .headers = {"strategy"},
                      .rows = {}};
  const std::vector<Column> list = columns(m);
  for (const Column& c : list) table.headers.push_back(c.title);
  table.headers.insert(table.headers.end(), {"left [%]", "RMS [um]", "95 % [um]", "covered [%]", "verdict"});
  for (const compensation::JudgedStrategy& s : m.strategies) {
    std::vector<std::string> row = {s.fitted.name};
    for (const Column& c : list) {
      const compensation::Worst w = compensation::worst_of(s, c.counts);
      row.push_back(w.peak ? um(w.peak->after.peak_abs) : "");
    }
    const compensation::Worst intact = compensation::worst_of(s, is_intact);
    row.push_back(percent(intact.left));
    row.push_back(fmt::format("{:.2f}", compensation::overall_rms(s)));
    row.push_back(s.fitted.interval_um ? um(*s.fitted.interval_um) : "-");
    row.push_back(percent(intact.mean_covered));
    row.push_back(s.fitted.is_baseline ? "baseline" : word(s.safety));
    table.rows.push_back(std::move(row));
  }
  return table;
}

output::Table worst_table(const compensation::StrategyMatrix& m) {
  output::Table table{.caption = "Worst case of each strategy with all sensors intact.",
                      .headers = {"strategy", "run", "peak before [um]", "peak left [um]", "removed [%]", "RMS left [um]",
                                  "without fail-safe [um]", "range in 60 min [um]", "range in all [um]",
                                  "peak with failed sensor [um]", "without fail-safe then [um]"},
                      .rows = {}};
  for (const compensation::JudgedStrategy& s : m.strategies) {
    const compensation::Worst w = compensation::worst_of(s, is_intact),
                              failed = compensation::worst_of(s, [](const compensation::Case&c) { return !is_intact(c); });
    if (!w.peak) continue;
    double bare = 0.0, bare_intact = 0.0;
    for (const compensation::Case& c : s.cases) {
      double& worst = is_intact(c) ? bare_intact : bare;
      worst = std::max(worst, c.peak_unguarded_um);
    }
    const compensation::Case& c = *w.peak;
    const compensation::JudgedRunOfMachine& r = m.runs[c.run];
    table.rows.push_back({s.fitted.name, r.season.empty() ? r.name : fmt::format("{}, {}", r.name, r.season),
                          um(c.before.peak_abs), um(c.after.peak_abs), fmt::format("{:.0f}", 100.0 * (1.0 - c.left())),
                          um(c.after.rmse), std::isinf(bare_intact) ? "no value" : um(bare_intact), um(c.first_hour_um),
                          um(c.whole_um), failed.peak ? um(failed.peak->after.peak_abs) : "",
                          failed.peak ? (std::isinf(bare) ? "no value" : um(bare)) : ""});
  }
  return table;
}

/// Of what is judged, all displacements and tilts that were recorded. The test begins in balance: a run that goes on from others has none.
std::vector<Iso230Run> judged_iso230_3(const compensation::StrategyMatrix& m) {
  std::vector<Iso230Run> list;
  for (const compensation::JudgedRunOfMachine& r : m.runs) {
    const std::string name = r.season.empty() ? r.name : fmt::format("{}, {}", r.name, r.season);
    list.push_back({name, r.run.n_before == 0 ? iso230_3_figures(r.run.readings)
                                              : Iso230Figures{.running_period_s = 0.0,
                                                              .channels = {},
                                                              .not_available = "the run goes on from what came before it"}});
  }
  return list;
}

/// Displacements and tilts of the runs that strategies leave as they are.
std::vector<std::string> other_axes(const compensation::StrategyMatrix& m) {
  std::vector<std::string> names;
  const Record& readings = m.runs.front().run.readings;
  for (const Channel& c : readings.channels) {
    const bool is_axis = c.unit == "um" || c.unit == "mm" || c.unit == "urad";
    if (is_axis && &c != readings.find(m.settings.strategies.target)) names.push_back(c.name);
  }
  return names;
}

/// Of which axis a verdict is; "" where no other was recorded.
std::string axis_text(const compensation::StrategyMatrix& m) {
  const std::vector<std::string> others = other_axes(m);
  if (others.empty()) return "";
  return fmt::format("Verdicts are of {} alone: no strategy here corrects or judges {}.", m.settings.strategies.target,
                     fmt::join(others, ", "));
}

std::string enough_text(const compensation::StrategyMatrix& m, const std::string& family) {
  const compensation::JudgedStrategy* s = compensation::simplest_enough(m, family);
  if (!s) return fmt::format("none keeps {:g} um", m.settings.tolerance_um);
  return s->fitted.name;
}

}  // namespace

std::vector<output::ReportBlock> strategy_blocks(const compensation::StrategyMatrix& m) {
  std::vector<output::ReportBlock> blocks;
  const compensation::JudgedStrategy* best = compensation::best_strategy(m);
  if (best) {
    const compensation::Worst intact = compensation::worst_of(*best, is_intact),
                              failed =
                                  compensation::worst_of(*best, [](const compensation::Case&c) { return !is_intact(c); });
    blocks.emplace_back(output::Verdict{
        best->safety == compensation::Safety::kUnsafe ? output::Verdict::Kind::kBad
        : best->safety == compensation::Safety::kSafe ? output::Verdict::Kind::kGood
                                                      : output::Verdict::Kind::kNeutral,
        fmt::format("{}: {}", best->fitted.name, word(best->safety)),
        fmt::format("It leaves the smallest share in its worst run, {:.0f} % of the peak{}. Why: {}.", 100.0 * intact.left,
                    failed.peak ? fmt::format(", {:.0f} % with one sensor failed", 100.0 * failed.left) : "", best->why)});
  }
  if (const std::string axis = axis_text(m); !axis.empty()) blocks.emplace_back(output::Paragraph{axis});
  blocks.emplace_back(output::Paragraph{fmt::format(
      "Residual: drift less the correction in force, that is the prediction times trust, clamped and slewed. The table has "
      "the worst run of each family in "
      "any season, then of each season{}. Left: the largest share of the peak. RMS: over all rows. 95 %: half width of the "
      "prediction interval, from training "
      "runs left out, and the share of rows that it covers. Fitted on {} training runs that are none of these.",
      has_failures(m) ? ", then with each sensor of the strategy failed half-way in the first season: stuck, open, fallen "
                        "off, drifting by 2 K/h either way, exchanged with the one least like it"
                      : "",
      m.training.size())});
  blocks.emplace_back(matrix_table(m));
  output::Table enough{
      .caption = "The simplest strategy that keeps the tolerance on every run of a family, in every season, sensors intact.",
      .headers = {"family", "enough"},
      .rows = {}};
  for (const std::string& family : compensation::families_of(m)) enough.rows.push_back({family, enough_text(m, family)});
  blocks.emplace_back(std::move(enough));
  output::Table verdicts{.caption = "Whether a strategy may go on the machine, and why.",
                         .headers = {"strategy", "verdict", "why", "keeps the tolerance in", "beaten by"},
                         .rows = {}};
  for (const compensation::JudgedStrategy& s : m.strategies) {
    if (!s.fitted.is_baseline)
      verdicts.rows.push_back(
          {s.fitted.name, word(s.safety), s.why, fmt::format("{}", fmt::join(s.limits, "; ")), s.beaten_by});
  }
  blocks.emplace_back(std::move(verdicts));
  blocks.emplace_back(
      output::Paragraph{"Ranges are those ISO 230-3 asks of drift, here of what is left: within 60 min, and in all. Without "
                        "fail-safe: of the bare prediction."});
  blocks.emplace_back(worst_table(m));
  output::Table doubted{
      .caption = "What fail-safes doubted though every sensor was intact: false alarms, which cost some of the correction.",
      .headers = {"strategy", "runs", "first of them"},
      .rows = {}};
  for (const compensation::JudgedStrategy& s : m.strategies) {
    int n = 0;
    std::string first;
    for (const compensation::Case& c : s.cases) {
      if (!is_intact(c) || c.events.empty()) continue;
      if (n++ == 0) first = fmt::format("{}: {}", m.runs[c.run].name, c.events.front());
    }
    if (n > 0) doubted.rows.push_back({s.fitted.name, fmt::format("{}", n), first});
  }
  if (!doubted.rows.empty()) blocks.emplace_back(std::move(doubted));
  output::Bars bars{.caption = "Largest share of the peak that is left in any run, sensors intact [%].", .bars = {}};
  for (const compensation::JudgedStrategy& s : m.strategies) {
    const double left = 100.0 * compensation::worst_of(s, is_intact).left;
    bars.bars.push_back({s.fitted.name, std::min(left, 200.0), fmt::format("{:.0f} %", left)});
  }
  blocks.emplace_back(std::move(bars));
  if (const Contrast c = contrast(m); c.simple && c.best) {
    std::vector<const compensation::JudgedStrategy*> shown = {c.simple, c.best};
    for (const compensation::JudgedStrategy& s : m.strategies) {
      if (s.fitted.name == "observer" && &s != c.best) shown.push_back(&s);
    }
    blocks.emplace_back(course(m, c.run, shown));
  }
  blocks.push_back(iso230_3_block(judged_iso230_3(m)));
  output::Table fits{
      .caption = "What each fit decided, on the training runs alone.", .headers = {"strategy", "decided"}, .rows = {}};
  for (const compensation::JudgedStrategy& s : m.strategies) {
    if (!s.fitted.reason.empty()) fits.rows.push_back({s.fitted.name, s.fitted.reason});
  }
  for (const compensation::LeftOut& l : m.left_out) fits.rows.push_back({l.name, "left out: " + l.why});
  blocks.emplace_back(std::move(fits));
  for (const compensation::JudgedStrategy& s : m.strategies) {
    if (const std::optional<output::DeployedModel> d = formula_of(s); d && s.fitted.name == "regression, forward") {
      blocks.emplace_back(output::Heading{"The formula of '" + s.fitted.name + "'"});
      blocks.emplace_back(output::Preformatted{output::formula_text(*d)});
    }
  }
  return blocks;
}

namespace {

/// What a strategy was found to be, on the runs of the matrix.
Json verdict_json(const compensation::JudgedStrategy& s) {
  const compensation::Worst intact = compensation::worst_of(s, is_intact),
                            failed = compensation::worst_of(s, [](const compensation::Case&c) { return !is_intact(c); });
  Json entry = Json::object();
  if (!s.fitted.is_baseline) {
    entry["verdict"] = word(s.safety);
    entry["worse_than_nothing"] = s.is_worse_than_nothing;
    entry["why"] = s.why;
    entry["keeps_tolerance_in"] = s.limits;
    entry["beaten_by"] = s.beaten_by;
  }
  entry["worst_left_percent"] = 100.0 * intact.left;
  entry["worst_peak_um"] = intact.peak ? intact.peak->after.peak_abs : NAN;
  entry["largest_rms_um"] = intact.rms_um;
  entry["overall_rms_um"] = compensation::overall_rms(s);
  if (failed.peak) {
    entry["failed_sensor_worst_left_percent"] = 100.0 * failed.left;
    entry["failed_sensor_worst_peak_um"] = failed.peak->after.peak_abs;
  }
  entry["interval_95_um"] = s.fitted.interval_um ? Json(*s.fitted.interval_um) : Json(nullptr);
  entry["covered_percent"] = s.fitted.interval_um ? Json(100.0 * intact.mean_covered) : Json(nullptr);
  return entry;
}

/// The conditions that all of them were judged under.
Json conditions_json(const compensation::StrategyMatrix& m) {
  Json j = {{"target", m.settings.strategies.target},
            {"not_judged", other_axes(m)},
            {"tolerance_um", m.settings.tolerance_um},
            {"count_from_start", m.settings.strategies.count_from_start},
            {"sensors_fail_at", m.settings.fails_at ? Json(*m.settings.fails_at) : Json(nullptr)},
            {"reading_K", m.settings.strategies.reading_K},
            {"drift_um", m.settings.strategies.drift_um}};
  for (const ObservedRun& r : m.training) {
    if (r.rows.file.empty()) {
      j["trained_on"].push_back(r.readings.source);
    } else {
      j["trained_on"].push_back({{"file", r.rows.file}, {"from_s", r.rows.first_s}, {"until_s", r.rows.last_s}});
    }
  }
  return j;
}

}  // namespace

Json strategy_json(const compensation::StrategyMatrix& m) {
  Json j = conditions_json(m);
  for (const compensation::JudgedStrategy& s : m.strategies) {
    Json entry = {{"name", s.fitted.name},
                  {"baseline", s.fitted.is_baseline},
                  {"sensors", s.fitted.sensors},
                  {"decided", s.fitted.reason}};
    entry.update(verdict_json(s));
    j["strategies"].push_back(std::move(entry));
  }
  for (const std::string& family : compensation::families_of(m)) j["simplest_enough"][family] = enough_text(m, family);
  j["left_out"] = Json::array();
  for (const compensation::LeftOut& l : m.left_out) j["left_out"].push_back({{"name", l.name}, {"why", l.why}});
  j["iso_230_3"] = iso230_3_json(judged_iso230_3(m));
  return j;
}

std::string strategy_csv(const compensation::StrategyMatrix& m) {
  std::string csv =
      "strategy,family,season,run,failed_sensor,peak_before_um,rms_before_um,peak_left_um,rms_left_um,mean_left_um,removed_"
      "percent,range_60min_um,range_um,"
      "peak_without_fail_safe_um,rms_without_fail_safe_um,covered_percent,rows,harm_um,doubted\n";
  for (const compensation::JudgedStrategy& s : m.strategies) {
    for (const compensation::Case& c : s.cases) {
      const compensation::JudgedRunOfMachine& r = m.runs[c.run];
      csv += fmt::format(
          "\"{}\",{},{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.2f},{:.4f},{:.4f},{},{},{},{},{:.4f},{}\n",
          s.fitted.name, csv_cell(r.family), csv_cell(r.season), csv_cell(r.name), csv_cell(c.failed), c.before.peak_abs,
          c.before.rmse, c.after.peak_abs, c.after.rmse, c.after.mean, 100.0 * (1.0 - c.left()), c.first_hour_um, c.whole_um,
          std::isfinite(c.peak_unguarded_um) ? fmt::format("{:.4f}", c.peak_unguarded_um) : "",
          std::isfinite(c.rms_unguarded_um) ? fmt::format("{:.6f}", c.rms_unguarded_um) : "",
          std::isfinite(c.covered) ? fmt::format("{:.2f}", 100.0 * c.covered) : "", c.after.n, c.harm_um,
          csv_cell(fmt::format("{}", fmt::join(c.events, "; "))));
    }
  }
  return csv;
}

std::string strategy_text(const compensation::StrategyMatrix& m) {
  const bool failures = has_failures(m);
  std::string text = fmt::format(
      "{} fitted on {} runs, judged on {} others: largest residual [um], share of the peak left [%]{}; RMS over all rows "
      "[um]\n",
      m.settings.strategies.target, m.training.size(), m.runs.size(), failures ? ", both with one sensor failed" : "");
  for (const compensation::JudgedStrategy& s : m.strategies) {
    const compensation::Worst intact = compensation::worst_of(s, is_intact),
                              failed = compensation::worst_of(s, [](const compensation::Case&c) { return !is_intact(c); });
    text += fmt::format("  {:<38} {:>7} {:>5}", s.fitted.name, intact.peak ? um(intact.peak->after.peak_abs) : "",
                        percent(intact.left));
    if (failures)
      text += fmt::format("   {:>7} {:>5}", failed.peak ? um(failed.peak->after.peak_abs) : "",
                          failed.peak ? percent(failed.left) : "");
    text += fmt::format("   RMS {:>6}", fmt::format("{:.2f}", compensation::overall_rms(s)));
    text += s.fitted.is_baseline ? "   baseline\n"
                                 : fmt::format("   {}{}{}\n", word(s.safety),
                                               s.is_worse_than_nothing ? ", worse than nothing in some case" : "",
                                               s.beaten_by.empty() ? "" : fmt::format(", but beaten by '{}'", s.beaten_by));
  }
  for (const compensation::LeftOut& l : m.left_out) text += fmt::format("  {:<38} left out: {}\n", l.name, l.why);
  for (const std::string& family : compensation::families_of(m))
    text += fmt::format("enough for '{}': {}\n", family, enough_text(m, family));
  if (const compensation::JudgedStrategy* best = compensation::best_strategy(m))
    text += fmt::format("best: {}, {}; {}\n", best->fitted.name, word(best->safety), best->why);
  if (const std::string axis = axis_text(m); !axis.empty()) text += axis + "\n";
  return text;
}

void write_models(const compensation::StrategyMatrix& m, const std::vector<effects::Effect>& effects,
                  output::ResultsFolder& folder) {
  bool has_formulas = false;
  for (const compensation::JudgedStrategy& s : m.strategies) {
    std::string name;
    for (char ch : s.fitted.name) {
      if (std::isalnum(static_cast<unsigned char>(ch))) {
        name += ch;
      } else if (!name.empty() && name.back() != '_') {
        name += '_';
      }
    }
    Json judged = conditions_json(m);
    for (const compensation::JudgedRunOfMachine& r : m.runs)
      judged["judged_on"].push_back({{"run", r.name}, {"family", r.family}, {"season", r.season}});
    judged["with_failed_sensors"] = has_failures(m);
    judged.update(verdict_json(s));
    folder.write_text(fmt::format("models/{}.json", name),
                      output::predictor_json({s.fitted, std::move(judged)}, effects, folder.made_by()).dump(1) + "\n");
    const std::optional<output::DeployedModel> formula = formula_of(s);
    if (!formula) continue;
    folder.write_text(fmt::format("models/{}.txt", name), output::formula_text(*formula));
    const std::string made_by =
        fmt::format("Driftwright {}, scenario {}", folder.made_by().version, folder.made_by().scenario);
    folder.write_text(fmt::format("models/{}.c", name), output::c_function(*formula, made_by));
    folder.write_text(fmt::format("models/{}_axis.comp", name),
                      output::linuxcnc_component(*formula, name + "_axis", name + ".c", made_by));
    has_formulas = true;
  }
  for (const ControlFile& file : control_files()) {
    if (has_formulas) folder.write_text("models/" + file.name, file.text);
  }
}

}  // namespace driftwright::app
