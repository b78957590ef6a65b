#include "findings/strategy_section.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "findings/cause_words.hpp"
#include "findings/iso230_3_section.hpp"
#include "findings/strategy_cases.hpp"
#include "findings/strategy_pictures.hpp"
#include "findings/strategy_tables.hpp"
#include "output/drift_model_files.hpp"

namespace driftwright::findings {
namespace {

using namespace compensation;
using output::Datum;
using output::Section;
using output::Table;
using output::Value;

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

/// The answer: whether the chosen strategy may go on the machine, and what it leaves.
output::Verdict verdict_of(const StrategyMatrix& m, const JudgedStrategy& chosen) {
  const Worst intact = worst_of(chosen, is_intact), failed = worst_of(chosen, has_failed);
  using Kind = output::Verdict::Kind;
  std::string text;
  if (intact.peak)
    text = fmt::format(
        "{} it leaves at most {:.1f} µm of {}; without correction that run has {:.1f} µm ({}). The tolerance is {:g} µm.",
        failed.peak ? "With all sensors intact" : "In the judged runs", intact.peak->after.peak_abs,
        m.settings.strategies.target, intact.peak->before.peak_abs, run_name(m.runs[intact.peak->run]),
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
    const bool may_have_one = e.kind->key == "coolant" || e.kind->key == "coolant_channel";
    return may_have_one && e["cooling_power"] > 0.0;
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
      std::any_of(m.training.begin(), m.training.end(), [](const MachineRun& r) { return !r.rows.file.empty(); });
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
  if (!chosen && !m.choice.why.empty())
    return {
        "Do not correct with what was fitted here. See whether each training record has the units and the sign of the "
        "others, "
        "and add records in which the machine drifts as it does in the judged ones."};
  if (!chosen)
    return {
        "Add training runs, at least two with different cyclograms (`--train`, or `train` under `validation`): parts of "
        "them are left out in turn to choose a strategy."};
  const std::string path = made_by.scenario.empty() ? "SCENARIO" : made_by.scenario;
  if (chosen->safety == Safety::kUnsafe) return steps_without(m, *chosen, scenario, path);
  const std::string file = output::path_in_results(made_by, model_file(m, *chosen));
  return {correction_step(m, scenario, path, file),
          fmt::format("`driftwright follow {}` then corrects beside the running machine{}.", file,
                      chosen->safety == Safety::kSafe ? "" : ", only within the limits above")};
}

/// The formula in readable form, if there is one.
void add_formula(Section& section, const StrategyMatrix& m) {
  for (const JudgedStrategy& s : m.strategies) {
    if (s.fitted.name != "regression, forward" || !s.fitted.predictor->formula()) continue;
    section.sections.push_back(
        {.title = "The formula of '" + s.fitted.name + "'",
         .blocks = {output::Preformatted{.text = output::formula_text(output::deployed_model(s.fitted))}},
         .detail = true});
  }
}

/// The conditions that all strategies were judged under: target, tolerance, training runs.
Section conditions_of(const StrategyMatrix& m) {
  const StrategySettings& how = m.settings.strategies;
  Section section;
  const auto put = [&](const char* key, Datum datum) { add(section, Value{.key = key, .datum = std::move(datum)}); };
  put("target", how.target);
  put("screw", how.place ? Datum(how.place->screw) : Datum());
  put("position_mm", how.place ? Datum(1e3 * how.place->at_m) : Datum());
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
  for (const MachineRun& r : m.training) {
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

Section strategy_numbers(const StrategyMatrix& m, const JudgedStrategy* chosen) {
  Section section{.title = "The numbers"};
  if (chosen) add(section, output::Text{choice_text(m, *chosen)});
  if (const std::string axis = axis_text(m); !axis.empty()) add(section, output::Text{axis});
  if (std::optional<output::Picture> failed = failed_map(m)) add(section, std::move(*failed));
  add(section, short_table(m));
  for (Table probing : {probing_table(m), probing_matrix(m), probe_faults_table(m)}) {
    if (!probing.rows.empty()) add(section, std::move(probing));
  }
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
  Table strategies = strategies_table(m);
  strategies.detail = true;
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

std::string models_folder(const StrategyMatrix& m) {
  return m.settings.strategies.place ? fmt::format("models/{}/", m.settings.strategies.target) : "models/";
}

std::string model_file(const StrategyMatrix& m, const JudgedStrategy& strategy) {
  return models_folder(m) + model_file_name(strategy.fitted.name) + ".json";
}

Section strategy_section(const StrategyMatrix& m, const scenarios::Scenario& scenario, const output::Provenance& made_by) {
  Section section = conditions_of(m);
  section.key = "validation";
  const JudgedStrategy* chosen = chosen_strategy(m);
  if (chosen) {
    add(section, Value{.key = "chosen", .datum = chosen->fitted.name});
    add(section, Value{.key = "why_chosen", .datum = m.choice.why});
    add(section, verdict_of(m, *chosen));
  } else {
    add(section,
        output::Verdict{
            .key = "",
            .title = "No strategy is chosen",
            .text = (m.choice.why.empty() ? "Too little can be left out of the training runs to choose one" : m.choice.why) +
                    ". The picture shows what each strategy leaves on the judged runs."});
  }
  add(section, intact_map(m));
  if (std::optional<output::Plot> course = hardest_course(m)) add(section, std::move(*course));
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
