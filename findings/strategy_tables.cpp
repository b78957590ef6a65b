#include "findings/strategy_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "findings/cause_words.hpp"
#include "findings/columns.hpp"
#include "findings/strategy_cases.hpp"

namespace driftwright::findings {

using namespace compensation;
using output::Datum, output::Table;

namespace {

/// One column of the matrix, with the cases whose worst it shows.
struct StrategyColumn {
  std::string title;
  std::function<bool(const Case&)> counts;
};
std::vector<StrategyColumn> strategy_columns(const StrategyMatrix& m) {
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

/// Replaces a value that is not finite, from a prediction that is missing.
Datum finite(double value) {
  return std::isfinite(value) ? Datum(value) : Datum("no value");
}

}  // namespace

Table matrix_table(const StrategyMatrix& m) {
  Table table{
      .key = "largest_residuals",
      .title = fmt::format("Largest |residual| in each family and season; tolerance {:g} µm", m.settings.tolerance_um),
      .columns = {{.key = "strategy", .title = "strategy"}},
      .detail = true};
  const std::vector<StrategyColumn> list = strategy_columns(m);
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
    table.rows.push_back({s.fitted.name, run_name(m.runs[c.run]), c.before.peak_abs, c.after.peak_abs,
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

Table strategies_table(const StrategyMatrix& m) {
  const auto for_failures = [&](const char* title) { return has_failures(m) ? title : ""; };
  Table table{.key = "strategies",
              .title = "All figures of each strategy",
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
  for (const JudgedStrategy& s : m.strategies) {
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

namespace {

constexpr const char* kWeighted = "weights by probings";

/// RMS over all rows, and the largest peak, of several runs.
struct LeftOverRuns {
  double squares = 0.0, n = 0.0, peak_um = 0.0;
  void add(const Score& s) {
    if (s.n == 0) return;
    squares += s.n * s.rmse * s.rmse;
    n += s.n;
    peak_um = std::max(peak_um, s.peak_abs);
  }
  [[nodiscard]] double rms_um() const { return std::sqrt(squares / n); }
};

bool is_weighted_intact(const WeightedCase& c) {
  return c.failed.empty();
}

template <class Counts>
LeftOverRuns left_of_weighted(const StrategyMatrix& m, std::size_t interval, const Counts& counts) {
  LeftOverRuns left;
  for (const WeightedCase& c : m.weighted) {
    if (counts(c)) left.add(c.probed[interval].left);
  }
  return left;
}

}  // namespace

Table probing_table(const StrategyMatrix& m) {
  Table table{.key = "probing"};
  const std::optional<Probing>& probing = m.settings.strategies.probing;
  if (!probing) return table;
  table.title =
      fmt::format("With a probing every {:.4g} min, noise {:.3g} µm", probing->every_s.front() / 60.0, probing->noise_um);
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
    LeftOverRuns left;
    for (const Case& c : s.cases) {
      if (is_intact(c) && !c.probed.empty()) left.add(c.probed.front().left);
    }
    if (left.n == 0.0) continue;
    table.rows.push_back({s.fitted.name, overall_rms(s), left.rms_um(), left.peak_um, s.fitted.residual->deviation_um,
                          s.fitted.residual->time_constant_s / 60.0});
  }
  if (const LeftOverRuns w = left_of_weighted(m, 0, is_weighted_intact); w.n > 0.0)
    table.rows.push_back({kWeighted, Datum(), w.rms_um(), w.peak_um, Datum(), Datum()});
  return table;
}

Table probing_matrix(const StrategyMatrix& m) {
  Table table{.key = "probing_matrix",
              .title = "Probing interval, strategy, failed sensor",
              .caption =
                  "Lost: time of the probings. Worse: judged runs, with and without failed sensors, on which more is left "
                  "(RMS) than without probings. 'weights by probings': all strategies but the baselines and the blend; "
                  "at each probing those that expected it gain weight (fixed share).",
              .columns = {{.key = "name", .title = "strategy"},
                          {.key = "every_min", .title = "every", .unit = "min", .digits = output::significant(4)},
                          {.key = "lost_min_per_h", .title = "lost per hour", .unit = "min", .digits = output::decimals(1)},
                          um_column("rms_um", "RMS", 2),
                          um_column("peak_um", "peak"),
                          um_column("failed_rms_um", "RMS, sensor failed", 2),
                          um_column("failed_peak_um", "peak, sensor failed"),
                          {.key = "worse", .title = "worse"},
                          {.key = "judged", .title = "of"}},
              .detail = true};
  const std::optional<Probing>& probing = m.settings.strategies.probing;
  if (!probing) return table;
  const auto or_none = [](const LeftOverRuns& left, double um) { return left.n > 0.0 ? Datum(um) : Datum(); };
  for (const JudgedStrategy& s : m.strategies) {
    LeftOverRuns intact, failed;
    for (const Case& c : s.cases) (is_intact(c) ? intact : failed).add(c.after);
    table.rows.push_back({s.fitted.name, Datum(), 0.0, or_none(intact, intact.rms_um()), or_none(intact, intact.peak_um),
                          or_none(failed, failed.rms_um()), or_none(failed, failed.peak_um), Datum(), Datum()});
    if (!s.fitted.residual) continue;
    for (std::size_t k = 0; k < probing->every_s.size(); ++k) {
      intact = failed = {};
      int n_worse = 0;
      for (const Case& c : s.cases) {
        (is_intact(c) ? intact : failed).add(c.probed[k].left);
        n_worse += c.probed[k].left.rmse > c.after.rmse;
      }
      table.rows.push_back({s.fitted.name, probing->every_s[k] / 60.0, 60.0 * probing->takes_s / probing->every_s[k],
                            or_none(intact, intact.rms_um()), or_none(intact, intact.peak_um),
                            or_none(failed, failed.rms_um()), or_none(failed, failed.peak_um), n_worse, s.cases.size()});
    }
  }
  for (std::size_t k = 0; k < probing->every_s.size() && !m.weighted.empty(); ++k) {
    const LeftOverRuns intact = left_of_weighted(m, k, is_weighted_intact);
    const LeftOverRuns failed = left_of_weighted(m, k, [](const WeightedCase& c) { return !is_weighted_intact(c); });
    table.rows.push_back({kWeighted, probing->every_s[k] / 60.0, 60.0 * probing->takes_s / probing->every_s[k],
                          intact.rms_um(), intact.peak_um, or_none(failed, failed.rms_um()), or_none(failed, failed.peak_um),
                          Datum(), m.weighted.size()});
  }
  return table;
}

Table probe_faults_table(const StrategyMatrix& m) {
  Table table{
      .key = "probe_faults",
      .title = "With a probe that fails half-way",
      .caption =
          "At the first interval, sensors intact, worst run. Stuck: it reads what it read last. Biased: it reads the "
          "tolerance too much. Noticed: number of the probing that is refused or taken as a jump, on the run "
          "where it takes longest; '-': on some run no probing is. An error below the bound of refusal cannot "
          "be noticed by probings: the axis is then wrong by it.",
      .columns = {{.key = "name", .title = "strategy"},
                  um_column("good_peak_um", "peak, good probe"),
                  um_column("stuck_peak_um", "peak, stuck"),
                  {.key = "stuck_noticed_at", .title = "noticed at"},
                  um_column("biased_peak_um", "peak, biased"),
                  {.key = "biased_noticed_at", .title = "noticed at"},
                  um_column("bound_um", "bound of refusal")},
      .detail = true};
  for (const JudgedStrategy& s : m.strategies) {
    LeftOverRuns good, stuck, biased;
    std::optional<int> stuck_at = 0, biased_at = 0;
    const auto later = [](std::optional<int>& at, const std::optional<int>& of_run) {
      at = at && of_run ? std::optional<int>(std::max(*at, *of_run)) : std::nullopt;
    };
    for (const Case& c : s.cases) {
      if (!c.stuck_probe || !c.biased_probe) continue;
      good.add(c.probed.front().left);
      stuck.add(c.stuck_probe->left);
      biased.add(c.biased_probe->left);
      later(stuck_at, c.stuck_probe->noticed_at);
      later(biased_at, c.biased_probe->noticed_at);
    }
    if (good.n == 0.0) continue;
    const auto shown = [](const std::optional<int>& at) { return at ? Datum(*at) : Datum(); };
    // of the first probing: four deviations of a residual of which nothing is known
    ProbeFeedback unprobed(*s.fitted.residual, s.fitted.probe, false);
    unprobed.row(0.0, 0.0, 0.0);
    const double bound_um = PROBE_REFUSED * std::hypot(unprobed.deviation_um(), s.fitted.probe.noise_um);
    table.rows.push_back(
        {s.fitted.name, good.peak_um, stuck.peak_um, shown(stuck_at), biased.peak_um, shown(biased_at), bound_um});
  }
  return table;
}

}  // namespace driftwright::findings
