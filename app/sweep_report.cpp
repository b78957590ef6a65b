#include "app/sweep_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/csv_row.hpp"
#include "studies/sweep_run.hpp"

namespace driftwright::app {
namespace {

using output::Plot;
using output::Table;
using scenarios::SweepPlan;
using scenarios::Variation;

constexpr std::size_t kMostPlots = 24, kMostPoints = 2000, kMostFailures = 50;

double number_of(const std::string& cell) {
  return cell.empty() ? std::nan("") : std::stod(cell);
}

double position_of(const Variation& v, const std::string& label) {
  const auto found = std::find_if(v.values.begin(), v.values.end(), [&](const auto& value) { return value.label == label; });
  return found == v.values.end() ? std::nan("") : static_cast<double>(found - v.values.begin() + 1);
}

/// Ranks from 1; equal values share their mean rank.
std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> rank(values.size());
  for (std::size_t i = 0, j = 0; i < order.size(); i = j) {
    while (j < order.size() && values[order[j]] == values[order[i]]) ++j;
    for (std::size_t k = i; k < j; ++k) rank[order[k]] = 0.5 * static_cast<double>(i + j + 1);
  }
  return rank;
}

/// Without NaN, sorted.
std::vector<double> sorted(const std::vector<double>& values) {
  std::vector<double> kept;
  std::copy_if(values.begin(), values.end(), std::back_inserter(kept), [](double v) { return !std::isnan(v); });
  std::sort(kept.begin(), kept.end());
  return kept;
}

double median(const std::vector<double>& in_order) {
  return 0.5 * (in_order[(in_order.size() - 1) / 2] + in_order[in_order.size() / 2]);
}

std::string axis_label(const Variation& v) {
  if (v.is_number) return v.unit.empty() ? v.name : fmt::format("{} [{}]", v.name, v.unit);
  std::string names;
  for (std::size_t i = 0; i < v.values.size() && i < 6; ++i)
    names += fmt::format("{}{} {}", i ? ", " : "", i + 1, v.values[i].label);
  return fmt::format("{}: {}{}", v.name, names, v.values.size() > 6 ? ", ..." : "");
}

Plot scatter(const Variation& v, const std::vector<double>& x, const std::string& result, const std::vector<double>& y) {
  Plot plot{.title = fmt::format("{} over {}", result, v.name),
            .x_label = axis_label(v),
            .y_label = result,
            .series = {},
            .bands = {},
            .marks = {},
            .half_width = true};
  output::Series series{.label = result, .x = {}, .y = {}, .style = output::Series::Style::kPoints};
  for (std::size_t i = 0; i < x.size() && series.x.size() < kMostPoints; ++i) {
    if (std::isnan(x[i]) || std::isnan(y[i])) continue;
    series.x.push_back(x[i]);
    series.y.push_back(y[i]);
  }
  plot.series.push_back(std::move(series));
  return plot;
}

Table results_table(const SweepPlan& plan, const SweepColumns& columns) {
  Table table{.caption = "Results over all members.", .headers = {"result", "least", "median", "greatest"}, .rows = {}};
  for (std::size_t i = 0; i < plan.collect.size(); ++i) {
    const std::vector<double> values = sorted(columns.results[i]);
    if (values.empty()) continue;
    table.rows.push_back({plan.collect[i].header(), fmt::format("{:.5g}", values.front()),
                          fmt::format("{:.5g}", median(values)), fmt::format("{:.5g}", values.back())});
  }
  return table;
}

Table correlation_table(const SweepPlan& plan, const SweepColumns& columns) {
  Table table{.caption =
                  "Rank correlation (Spearman) of each result with each varied number: +1 or -1 where one alone decides "
                  "the order, near 0 where it does not matter.",
              .headers = {"result"},
              .rows = {}};
  for (const Variation& v : plan.variations) {
    if (v.is_number) table.headers.push_back(v.header());
  }
  for (std::size_t i = 0; i < plan.collect.size(); ++i) {
    table.rows.push_back({plan.collect[i].header()});
    for (std::size_t j = 0; j < plan.variations.size(); ++j) {
      if (!plan.variations[j].is_number) continue;
      const double r = rank_correlation(columns.varied[j], columns.results[i]);
      table.rows.back().push_back(std::isnan(r) ? "" : fmt::format("{:+.2f}", r));
    }
  }
  return table;
}

const char* words(scenarios::Design design) {
  switch (design) {
    case scenarios::Design::kList:
      return "list";
    case scenarios::Design::kGrid:
      return "grid";
    case scenarios::Design::kLatinHypercube:
      return "Latin hypercube";
  }
  return "";
}

}  // namespace

double rank_correlation(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> a, b;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isnan(x[i]) || std::isnan(y[i])) continue;
    a.push_back(x[i]);
    b.push_back(y[i]);
  }
  a = ranks(a);
  b = ranks(b);
  const double mean = 0.5 * (static_cast<double>(a.size()) + 1.0);  // of ranks 1 ... n
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - mean) * (b[i] - mean);
    aa += (a[i] - mean) * (a[i] - mean);
    bb += (b[i] - mean) * (b[i] - mean);
  }
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : std::nan("");
}

SweepColumns sweep_columns(const SweepPlan& plan, const output::NumberedRows& rows) {
  SweepColumns columns;
  columns.varied.resize(plan.variations.size());
  columns.results.resize(plan.collect.size());
  for (const auto& [number, row] : rows) {
    const std::vector<std::string> cells = csv_cells(row);
    for (std::size_t i = 0; i < plan.variations.size(); ++i) {
      const Variation& v = plan.variations[i];
      columns.varied[i].push_back(v.is_number ? number_of(cells.at(1 + i)) : position_of(v, cells.at(1 + i)));
    }
    for (std::size_t i = 0; i < plan.collect.size(); ++i)
      columns.results[i].push_back(number_of(cells.at(1 + plan.variations.size() + i)));
    columns.n_failed += studies::is_done(row) ? 0 : 1;
  }
  return columns;
}

std::string sweep_summary(const SweepPlan& plan, const SweepColumns& columns) {
  std::string text;
  for (std::size_t i = 0; i < plan.collect.size(); ++i) {
    const std::vector<double> values = sorted(columns.results[i]);
    if (values.empty()) continue;
    text += fmt::format("  {:<40} {:>10.5g} to {:>10.5g}, median {:>10.5g}\n", plan.collect[i].header(), values.front(),
                        values.back(), median(values));
  }
  return text;
}

output::Report sweep_report(const SweepPlan& plan, const output::NumberedRows& rows, const SweepColumns& columns,
                            const output::Provenance& made_by) {
  output::Report report{.title = plan.name + ": sweep",
                        .subtitle = fmt::format("Driftwright {}, study {}; {}, {} members", made_by.version,
                                                made_by.scenario, words(plan.design), rows.size()),
                        .blocks = {}};
  const auto add = [&](auto block) { report.blocks.emplace_back(std::move(block)); };
  if (columns.n_failed > 0) {
    add(output::Verdict{output::Verdict::Kind::kBad, fmt::format("{} of {} members failed", columns.n_failed, rows.size()),
                        "The column `status` of sweep.csv says why; all else here is about the others."});
    Table failures{.caption = "Members that failed.", .headers = {"member", "why"}, .rows = {}};
    for (const auto& [number, row] : rows) {
      if (!studies::is_done(row) && failures.rows.size() < kMostFailures)
        failures.rows.push_back({std::to_string(number), csv_cells(row).back()});
    }
    add(std::move(failures));
  }
  add(output::Heading{"Results"});
  add(results_table(plan, columns));
  add(correlation_table(plan, columns));
  add(output::Heading{"Results over what varies"});
  std::vector<Plot> plots;
  std::size_t n_all = 0;
  for (std::size_t i = 0; i < plan.collect.size(); ++i) {
    if (plan.collect[i].scalar == scenarios::Scalar::kTimeOfPeak) continue;
    for (std::size_t j = 0; j < plan.variations.size(); ++j) {
      if (n_all++ < kMostPlots)
        plots.push_back(scatter(plan.variations[j], columns.varied[j], plan.collect[i].header(), columns.results[i]));
    }
  }
  for (Plot& plot : plots) add(std::move(plot));
  if (n_all > kMostPlots)
    add(output::Paragraph{fmt::format("The first {} of {} pairs; all are in sweep.csv.", kMostPlots, n_all)});
  if (rows.size() > kMostPoints) add(output::Paragraph{fmt::format("Plots show the first {} members.", kMostPoints)});
  return report;
}

}  // namespace driftwright::app
