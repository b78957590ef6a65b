#include "findings/sweep_document.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/csv_row.hpp"
#include "output/tornado_picture.hpp"
#include "studies/sobol_indices.hpp"
#include "studies/sweep_run.hpp"

namespace driftwright::findings {
namespace {

using output::Plot, output::Table;
using scenarios::SweepPlan, scenarios::Variation;
using studies::SweepColumns;

constexpr std::size_t kMostSweepPlots = 24, kMostSweepPoints = 2000, kMostFailures = 50, kMostTornados = 6;

std::string axis_label(const Variation& v) {
  if (v.is_number) return v.unit.empty() ? v.name : fmt::format("{} [{}]", v.name, v.unit);
  std::string names;
  for (std::size_t i = 0; i < v.values.size() && i < 6; ++i)
    names += fmt::format("{}{} {}", i ? ", " : "", i + 1, v.values[i].label);
  return fmt::format("{}: {}{}", v.name, names, v.values.size() > 6 ? ", ..." : "");
}

Plot scatter(const Variation& v, const std::vector<double>& x, const std::string& result, const std::vector<double>& y) {
  Plot plot{
      .title = fmt::format("{} over {}", result, v.name), .x_label = axis_label(v), .y_label = result, .half_width = true};
  output::Series series{.label = result, .x = {}, .y = {}, .style = output::Series::Style::kPoints};
  for (std::size_t i = 0; i < x.size() && series.x.size() < kMostSweepPoints; ++i) {
    if (std::isnan(x[i]) || std::isnan(y[i])) continue;
    series.x.push_back(x[i]);
    series.y.push_back(y[i]);
  }
  plot.series.push_back(std::move(series));
  return plot;
}

Table results_table(const SweepPlan& plan, const SweepColumns& columns) {
  constexpr output::Digits kFive = output::significant(5);
  Table table{.key = "results",
              .title = "Results over all members",
              .columns = {{.key = "result", .title = "result"},
                          {.key = "least", .title = "least", .digits = kFive},
                          {.key = "median", .title = "median", .digits = kFive},
                          {.key = "greatest", .title = "greatest", .digits = kFive}}};
  for (std::size_t i = 0; i < plan.collect.size(); ++i) {
    if (const auto spread = studies::spread_of(columns.results[i]))
      table.rows.push_back({plan.collect[i].header(), spread->least, spread->median, spread->greatest});
  }
  return table;
}

Table correlation_table(const SweepPlan& plan, const SweepColumns& columns) {
  Table table{.key = "rank_correlations",
              .title = "Rank correlation (Spearman) of each result with each varied number",
              .caption = "+1 or -1 where one alone decides the order, near 0 where it does not matter.",
              .columns = {{.key = "result", .title = "result"}},
              .detail = true};
  for (const Variation& v : plan.variations) {
    if (v.is_number) table.columns.push_back({.key = v.header(), .title = v.header(), .digits = output::signed_decimals(2)});
  }
  for (std::size_t i = 0; i < plan.collect.size(); ++i) {
    std::vector<output::Datum> row = {plan.collect[i].header()};
    for (std::size_t j = 0; j < plan.variations.size(); ++j) {
      if (plan.variations[j].is_number) row.emplace_back(studies::rank_correlation(columns.varied[j], columns.results[i]));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table sobol_table(const SweepPlan& plan, const SweepColumns& columns) {
  constexpr output::Digits kTwo = output::decimals(2);
  Table table{.key = "sobol_indices",
              .title = "Sobol' indices: shares of the variance of each result",
              .caption =
                  "First order: what the number makes alone. Total: with all that it makes together with other numbers. "
                  "Intervals: 95 %, by bootstrap; more `samples` make them narrower. They hold for the distributions of "
                  "`vary`.",
              .columns = {{.key = "result", .title = "result"},
                          {.key = "varied", .title = "varied"},
                          {.key = "first_order", .title = "first order", .digits = kTwo},
                          {.key = "first_order_ci95", .title = "95 %", .digits = kTwo},
                          {.key = "total", .title = "total", .digits = kTwo},
                          {.key = "total_ci95", .title = "95 %", .digits = kTwo}}};
  for (std::size_t i = 0; i < plan.collect.size(); ++i) {
    const auto indices = studies::sobol_indices(columns.results[i], plan.variations.size());
    if (!indices) continue;
    for (std::size_t j = 0; j < indices->size(); ++j) {
      const auto& [first, total] = (*indices)[j];
      table.rows.push_back({plan.collect[i].header(), plan.variations[j].header(), first.value,
                            std::vector<double>{first.low, first.high}, total.value,
                            std::vector<double>{total.low, total.high}});
    }
  }
  return table;
}

std::string end_text(const Variation& v, double end) {
  return v.unit.empty() ? fmt::format("{:.3g}", end) : fmt::format("{:.3g} {}", end, output::shown_unit(v.unit));
}

/// What each number does to each result: a table, and a tornado of the first results.
void add_tornados(output::Section& section, const SweepPlan& plan, const SweepColumns& columns) {
  constexpr output::Digits kFive = output::significant(5);
  Table table{.key = "tornado",
              .title = "Each result from one end of a varied number to the other",
              .caption =
                  "All other numbers at their means, by least squares over the members. The ends of a distribution are the "
                  "values that 2.5 % and 97.5 % of all lie below. R² says how much of the variance this explains; far "
                  "below 1 the numbers act together or bend the result.",
              .columns = {{.key = "result", .title = "result"},
                          {.key = "varied", .title = "varied"},
                          {.key = "low", .title = "low end", .digits = kFive},
                          {.key = "high", .title = "high end", .digits = kFive},
                          {.key = "at_low", .title = "result at the low end", .digits = kFive},
                          {.key = "at_high", .title = "at the high end", .digits = kFive},
                          {.key = "r2", .title = "R²", .digits = output::decimals(2)}},
              .detail = true};
  std::size_t n_pictures = 0;
  for (std::size_t i = 0; i < plan.collect.size(); ++i) {
    const auto tornado = studies::tornado_of(plan, columns, i);
    if (!tornado) continue;
    output::TornadoPicture picture{.unit = plan.collect[i].header(), .middle = tornado->mean};
    for (const studies::EndToEnd& bar : tornado->bars) {
      const Variation& v = plan.variations[bar.variation];
      table.rows.push_back(
          {plan.collect[i].header(), v.header(), bar.low, bar.high, bar.at_low, bar.at_high, tornado->explained});
      picture.bars.push_back({.label = v.name,
                              .at_low = bar.at_low,
                              .at_high = bar.at_high,
                              .low = end_text(v, bar.low),
                              .high = end_text(v, bar.high)});
    }
    if (plan.collect[i].scalar == scenarios::Scalar::kTimeOfPeak || n_pictures++ >= kMostTornados) continue;
    add(section, output::Picture{.title = fmt::format("{} from one end of each number to the other (R² {:.2f})",
                                                      plan.collect[i].header(), tornado->explained),
                                 .svg = output::draw_tornado(picture)});
  }
  add(section, std::move(table));
}

const char* words(scenarios::Design design) {
  switch (design) {
    case scenarios::Design::kList:
      return "list";
    case scenarios::Design::kGrid:
      return "grid";
    case scenarios::Design::kLatinHypercube:
      return "Latin hypercube";
    case scenarios::Design::kSobol:
      return "samples for Sobol' indices";
  }
  return "";
}

}  // namespace

output::Document sweep_document(const SweepPlan& plan, const std::map<std::size_t, std::string>& rows,
                                const output::Provenance& made_by) {
  const SweepColumns columns = studies::sweep_columns(plan, rows);
  output::Document document{.made_by = made_by,
                            .title = fmt::format("{}: {} members, {} failed", plan.name, rows.size(), columns.n_failed),
                            .subtitle = words(plan.design)};
  output::Section& body = document.body;
  add(body, output::Value{.key = "n_members", .datum = rows.size()});
  add(body, output::Value{.key = "n_failed", .datum = columns.n_failed});
  if (columns.n_failed > 0) {
    add(body, output::Verdict{.kind = output::Verdict::Kind::kBad,
                              .title = fmt::format("{} of {} members failed", columns.n_failed, rows.size()),
                              .text = "The column `status` of sweep.csv says why; all else here is about the others."});
    Table failures{.key = "failures",
                   .title = "Members that failed",
                   .columns = {{.key = "member", .title = "member"}, {.key = "why", .title = "why"}},
                   .detail = true};
    for (const auto& [number, row] : rows) {
      if (!studies::is_done(row) && failures.rows.size() < kMostFailures)
        failures.rows.push_back({number, csv_cells(row).back()});
    }
    add(body, std::move(failures));
  }
  output::Section results{.title = "Results"};
  add(results, results_table(plan, columns));
  if (plan.design == scenarios::Design::kSobol && rows.size() == plan.n_members) add(results, sobol_table(plan, columns));
  add_tornados(results, plan, columns);
  add(results, correlation_table(plan, columns));
  body.sections.push_back(std::move(results));
  output::Section plots{.title = "Results over what varies"};
  std::size_t n_all = 0;
  for (std::size_t i = 0; i < plan.collect.size(); ++i) {
    if (plan.collect[i].scalar == scenarios::Scalar::kTimeOfPeak) continue;
    for (std::size_t j = 0; j < plan.variations.size(); ++j) {
      if (n_all++ < kMostSweepPlots)
        add(plots, scatter(plan.variations[j], columns.varied[j], plan.collect[i].header(), columns.results[i]));
    }
  }
  const auto remark = [&](const std::string& words) { add(plots, output::Text{.words = words, .detail = true}); };
  if (n_all > kMostSweepPlots)
    remark(fmt::format("The first {} of {} pairs; all are in sweep.csv.", kMostSweepPlots, n_all));
  if (rows.size() > kMostSweepPoints) remark(fmt::format("Plots show the first {} members.", kMostSweepPoints));
  body.sections.push_back(std::move(plots));
  return document;
}

}  // namespace driftwright::findings
