#include "studies/sweep_statistics.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/csv_row.hpp"
#include "studies/sweep_run.hpp"

namespace driftwright::studies {
namespace {

using scenarios::SweepPlan, scenarios::Variation;

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

namespace {

bool is_log(const Variation& v) {
  return v.spread && v.spread->kind == scenarios::Spread::Kind::kLogUniform;
}

/// The ends of a varied number. @param values  of the members
std::pair<double, double> ends_of(const Variation& v, const std::vector<double>& values) {
  if (v.spread) return {v.spread->at(0.025), v.spread->at(0.975)};
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  return {*least, *greatest};
}

}  // namespace

std::optional<Tornado> tornado_of(const SweepPlan& plan, const SweepColumns& columns, std::size_t result) {
  std::vector<std::size_t> numbers, members;
  for (std::size_t v = 0; v < plan.variations.size(); ++v) {
    if (plan.variations[v].is_number) numbers.push_back(v);
  }
  const std::vector<double>& all = columns.results[result];
  for (std::size_t m = 0; m < all.size(); ++m) {
    if (!std::isnan(all[m])) members.push_back(m);
  }
  if (numbers.empty() || members.size() < 2 * numbers.size() + 2) return std::nullopt;

  const auto n = static_cast<Eigen::Index>(members.size()), n_numbers = static_cast<Eigen::Index>(numbers.size());
  const auto scaled = [&](std::size_t v, double number) { return is_log(plan.variations[v]) ? std::log(number) : number; };
  Eigen::MatrixXd x(n, n_numbers);
  Eigen::VectorXd y(n);
  for (Eigen::Index m = 0; m < n; ++m) {
    const std::size_t member = members[static_cast<std::size_t>(m)];
    y[m] = all[member];
    for (Eigen::Index i = 0; i < n_numbers; ++i) {
      const std::size_t v = numbers[static_cast<std::size_t>(i)];
      x(m, i) = scaled(v, columns.varied[v][member]);
    }
  }
  const Eigen::RowVectorXd mean = x.colwise().mean();
  Tornado tornado{.mean = y.mean(), .explained = 0.0, .bars = {}};
  x.rowwise() -= mean;
  y.array() -= tornado.mean;
  const Eigen::RowVectorXd size = x.colwise().norm();
  if (!(y.squaredNorm() > 0.0) || !(size.minCoeff() > 0.0)) return std::nullopt;
  x.array().rowwise() /= size.array();  // numbers of all magnitudes count alike for the rank
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> fit(x);
  if (fit.rank() < n_numbers) return std::nullopt;
  const Eigen::VectorXd slope = fit.solve(y);
  tornado.explained = 1.0 - (y - x * slope).squaredNorm() / y.squaredNorm();
  for (Eigen::Index i = 0; i < n_numbers; ++i) {
    const std::size_t v = numbers[static_cast<std::size_t>(i)];
    const auto [low, high] = ends_of(plan.variations[v], columns.varied[v]);
    const auto at = [&](double number) { return tornado.mean + slope[i] * (scaled(v, number) - mean[i]) / size[i]; };
    tornado.bars.push_back({.variation = v, .low = low, .high = high, .at_low = at(low), .at_high = at(high)});
  }
  std::stable_sort(tornado.bars.begin(), tornado.bars.end(), [](const EndToEnd& a, const EndToEnd& b) {
    return std::abs(a.at_high - a.at_low) > std::abs(b.at_high - b.at_low);
  });
  return tornado;
}

}  // namespace driftwright::studies
