#include "compensation/sensors/sensor_selection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/errors.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kMostSets = 2e6;
constexpr int kPathSteps = 400;            // of the LASSO
constexpr double kSmallestPenalty = 1e-5;  // of the largest
constexpr int kMostSweeps = 300;           // per step: nearly equal sensors exchange their shares endlessly
constexpr double kConverged = 1e-9;        // change of a scaled coefficient in a sweep

/// Correlations of inputs and target (last) over all records.
Eigen::MatrixXd correlations(const ProductSums& sums) {
  const Eigen::MatrixXd total = sums.total();
  const Eigen::Index m = total.rows() - 1;
  return total.bottomRightCorner(m, m) / total(0, 0);  // columns have mean 0 and deviation 1
}

std::vector<int> moving(const ProductSums& sums) {
  std::vector<int> columns;
  for (int j = 0; j < sums.n_inputs(); ++j) {
    if (!sums.is_constant[static_cast<std::size_t>(j)]) columns.push_back(j);
  }
  if (columns.empty())
    throw InputError(fmt::format("none of the candidates ever changes: {}", fmt::join(sums.inputs, ", ")));
  return columns;
}

std::vector<std::string> names(const ProductSums& sums, std::span<const int> columns) {
  std::vector<std::string> result;
  for (int j : columns) result.push_back(sums.inputs[static_cast<std::size_t>(j)]);
  return result;
}

double combinations(int m, int n) {
  double count = 1.0;
  for (int i = 0; i < n; ++i) count *= static_cast<double>(m - i) / (i + 1);
  return count;
}

/// Columns by falling |correlation| with the target.
std::vector<int> by_correlation(const Eigen::MatrixXd& r, std::vector<int> columns) {
  const Eigen::Index y = r.rows() - 1;
  std::stable_sort(columns.begin(), columns.end(), [&](int a, int b) { return std::abs(r(a, y)) > std::abs(r(b, y)); });
  return columns;
}

}  // namespace

Selection select_by_grey_grade(std::span<const Record> records, const std::vector<std::string>& candidates,
                               const std::string& target, int n, const GreyOptions& options) {
  const Ranking ranking = rank_channels(records, target, candidates, options);
  Selection s{.sensors = best(ranking, n), .reason = {}};
  std::vector<std::string> grades;
  for (std::size_t i = 0; i < s.sensors.size(); ++i) grades.push_back(fmt::format("{:.3f}", *ranking.channels[i].grade));
  s.reason = fmt::format("largest grey relational grades: {}", fmt::join(grades, ", "));
  return s;
}

Selection select_by_correlation(std::span<const Record> records, const std::vector<std::string>& candidates,
                                const std::string& target, int n) {
  const ProductSums sums = product_sums(records, candidates, target);
  const Eigen::MatrixXd r = correlations(sums);
  std::vector<int> columns = by_correlation(r, moving(sums));
  columns.resize(std::min(columns.size(), static_cast<std::size_t>(n)));
  std::vector<std::string> values;
  for (int j : columns) values.push_back(fmt::format("{:.3f}", r(j, r.cols() - 1)));
  return {names(sums, columns), fmt::format("largest correlations with the drift: {}", fmt::join(values, ", "))};
}

Selection select_by_clusters(std::span<const Record> records, const std::vector<std::string>& candidates,
                             const std::string& target, int n) {
  const ProductSums sums = product_sums(records, candidates, target);
  const Eigen::MatrixXd r = correlations(sums);
  std::vector<std::vector<int>> clusters;
  for (int j : moving(sums)) clusters.push_back({j});
  const auto distance = [&](const std::vector<int>& a, const std::vector<int>& b) {
    double sum = 0.0;
    for (int i : a) {
      for (int j : b) sum += 1.0 - std::abs(r(i, j));
    }
    return sum / static_cast<double>(a.size() * b.size());
  };
  while (static_cast<int>(clusters.size()) > n) {
    std::size_t first = 0, second = 1;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < clusters.size(); ++a) {
      for (std::size_t b = a + 1; b < clusters.size(); ++b) {
        const double d = distance(clusters[a], clusters[b]);
        if (d < nearest) {
          nearest = d;
          first = a;
          second = b;
        }
      }
    }
    clusters[first].insert(clusters[first].end(), clusters[second].begin(), clusters[second].end());
    clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(second));
  }
  std::vector<int> chosen;
  for (const std::vector<int>& cluster : clusters) chosen.push_back(by_correlation(r, cluster).front());
  chosen = by_correlation(r, chosen);
  std::vector<std::string> words;
  for (int j : chosen) {
    for (const std::vector<int>& cluster : clusters) {
      if (std::find(cluster.begin(), cluster.end(), j) == cluster.end()) continue;
      words.push_back(
          fmt::format("{} for {{{}}}", sums.inputs[static_cast<std::size_t>(j)], fmt::join(names(sums, cluster), ", ")));
    }
  }
  return {names(sums, chosen), fmt::format("one of each cluster of sensors that move alike: {}", fmt::join(words, "; "))};
}

Selection select_forward(std::span<const Record> records, const std::vector<std::string>& candidates,
                         const std::string& target, int n) {
  const ProductSums sums = product_sums(records, candidates, target);
  std::vector<int> chosen, left = moving(sums);
  std::vector<std::string> errors;
  double before = std::numeric_limits<double>::infinity();
  while (static_cast<int>(chosen.size()) < n && !left.empty()) {
    std::size_t best_at = 0;
    double best_error = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < left.size(); ++i) {
      std::vector<int> trial = chosen;
      trial.push_back(left[i]);
      const double error = held_out_rmse(sums, trial);
      if (error < best_error) {
        best_error = error;
        best_at = i;
      }
    }
    if (!(best_error < before)) break;
    before = best_error;
    chosen.push_back(left[best_at]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best_at));
    errors.push_back(fmt::format("{:.3g}", best_error));
  }
  return {names(sums, chosen), fmt::format("RMS error of runs left out falls to {} {} with each of them",
                                           fmt::join(errors, ", "), sums.target_unit)};
}

void for_each_set(int n_columns, int n, const std::function<void(std::span<const int>)>& visit) {
  if (n < 1 || n > n_columns) return;
  std::vector<int> set(static_cast<std::size_t>(n));
  std::iota(set.begin(), set.end(), 0);
  while (true) {
    visit(set);
    int i = n - 1;
    while (i >= 0 && set[static_cast<std::size_t>(i)] == n_columns - n + i) --i;
    if (i < 0) return;
    ++set[static_cast<std::size_t>(i)];
    for (int j = i + 1; j < n; ++j) set[static_cast<std::size_t>(j)] = set[static_cast<std::size_t>(j) - 1] + 1;
  }
}

Selection select_best_set(std::span<const Record> records, const std::vector<std::string>& candidates,
                          const std::string& target, int n) {
  const ProductSums sums = product_sums(records, candidates, target);
  const std::vector<int> columns = moving(sums);
  const int m = static_cast<int>(columns.size()), k = std::min(n, m);
  const double n_sets = combinations(m, k);
  if (n_sets > kMostSets) {
    throw InputError(fmt::format("{:.3g} sets of {} out of {} sensors are more than {:.3g}; choose fewer, or `forward`",
                                 n_sets, k, m, kMostSets));
  }
  std::vector<int> best_columns;
  double best_error = std::numeric_limits<double>::infinity();
  for_each_set(m, k, [&](std::span<const int> set) {
    std::vector<int> trial;
    for (int i : set) trial.push_back(columns[static_cast<std::size_t>(i)]);
    const double error = held_out_rmse(sums, trial);
    if (error < best_error) {
      best_error = error;
      best_columns = std::move(trial);
    }
  });
  return {
      names(sums, by_correlation(correlations(sums), best_columns)),
      fmt::format("the best of {:.0f} sets: RMS error {:.3g} {} on runs left out", n_sets, best_error, sums.target_unit)};
}

Selection select_by_lasso(std::span<const Record> records, const std::vector<std::string>& candidates,
                          const std::string& target, int n) {
  const ProductSums sums = product_sums(records, candidates, target);
  const std::vector<int> columns = moving(sums);
  const Eigen::MatrixXd r = correlations(sums);
  const Eigen::Index y = r.rows() - 1;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(y);
  double largest = 0.0;
  for (int j : columns) largest = std::max(largest, std::abs(r(j, y)));
  std::vector<int> active;
  double penalty = largest;
  for (int step = 1; step <= kPathSteps && static_cast<int>(active.size()) < n; ++step) {
    penalty = largest * std::pow(kSmallestPenalty, static_cast<double>(step) / kPathSteps);
    double change = 1.0;
    for (int sweep = 0; sweep < kMostSweeps && change > kConverged; ++sweep) {
      change = 0.0;
      for (int j : columns) {
        const double pull = r(j, y) - r.row(j).head(y).dot(b) + b(j);
        const double next = std::copysign(std::max(std::abs(pull) - penalty, 0.0), pull);
        change = std::max(change, std::abs(next - b(j)));
        b(j) = next;
      }
    }
    active.clear();
    for (int j : columns) {
      if (b(j) != 0.0) active.push_back(j);
    }
  }
  std::stable_sort(active.begin(), active.end(), [&](int p, int q) { return std::abs(b(p)) > std::abs(b(q)); });
  active.resize(std::min(active.size(), static_cast<std::size_t>(n)));
  return {names(sums, active), fmt::format("in the LASSO's path at a penalty of {:.2g} of the largest", penalty / largest)};
}

std::vector<Selector> selectors(const GreyOptions& grey) {
  const auto by_grade = [grey](std::span<const Record> records, const std::vector<std::string>& candidates,
                               const std::string& target,
                               int n) { return select_by_grey_grade(records, candidates, target, n, grey); };
  return {{"grey grade", by_grade},    {"correlation", select_by_correlation}, {"clusters", select_by_clusters},
          {"forward", select_forward}, {"best set", select_best_set},          {"LASSO", select_by_lasso}};
}

}  // namespace driftwright::compensation
