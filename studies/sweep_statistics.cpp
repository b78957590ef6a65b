#include "studies/sweep_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/csv_row.hpp"
#include "studies/sweep_run.hpp"

namespace driftwright::studies {
namespace {

using scenarios::SweepPlan;
using scenarios::Variation;

double number_of(const std::string& cell) {
  return cell.empty() ? std::nan("") : std::strtod(cell.c_str(), nullptr);
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
  const double mean = 0.5 * (static_cast<double>(a.size()) + 1.0);  // of the ranks 1 ... n
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - mean) * (b[i] - mean);
    aa += (a[i] - mean) * (a[i] - mean);
    bb += (b[i] - mean) * (b[i] - mean);
  }
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : std::nan("");
}

SweepColumns sweep_columns(const SweepPlan& plan, const std::map<std::size_t, std::string>& rows) {
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
    columns.n_failed += is_done(row) ? 0 : 1;
  }
  return columns;
}

std::optional<Spread> spread_of(const std::vector<double>& values) {
  std::vector<double> kept;
  std::copy_if(values.begin(), values.end(), std::back_inserter(kept), [](double v) { return !std::isnan(v); });
  if (kept.empty()) return std::nullopt;
  std::sort(kept.begin(), kept.end());
  return Spread{kept.front(), 0.5 * (kept[(kept.size() - 1) / 2] + kept[kept.size() / 2]), kept.back()};
}

}  // namespace driftwright::studies
