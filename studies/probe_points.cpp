#include "studies/probe_points.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "base/errors.hpp"
#include "studies/table_study.hpp"

namespace driftwright::studies {
namespace {

using Points = std::vector<std::size_t>;

constexpr double kMostSets = 20000.0;
constexpr double kLeastVariance = 1e-9;  // of the largest: a point that never errs, or a combination of others

Eigen::MatrixXd part_of(const Eigen::MatrixXd& all, std::span<const std::size_t> rows,
                        std::span<const std::size_t> columns) {
  Eigen::MatrixXd part(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < columns.size(); ++j)
      part(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          all(static_cast<Eigen::Index>(rows[i]), static_cast<Eigen::Index>(columns[j]));
  }
  return part;
}

/// The coordinates of points.
Points coordinates_of(const PointErrors& errors, std::span<const std::size_t> points) {
  Points list;
  for (std::size_t point : points) {
    for (std::size_t k = 0; k < errors.n_coordinates; ++k) list.push_back(point * errors.n_coordinates + k);
  }
  return list;
}

/// Covariance of the coordinates that count after a probing of others.
Eigen::MatrixXd after_probing(const PointErrors& errors, const Points& probed, std::span<const std::size_t> counting,
                              double noise_um) {
  const Eigen::MatrixXd& c = errors.covariance_um2;
  Eigen::MatrixXd left = part_of(c, counting, counting);
  if (probed.empty()) return left;
  Eigen::MatrixXd read = part_of(c, probed, probed);
  read.diagonal().array() += noise_um * noise_um;
  const Eigen::MatrixXd with = part_of(c, probed, counting);
  return left - with.transpose() * read.ldlt().solve(with);
}

/// Half the logarithm of the determinant; directions in which errors never were do not count.
double half_log_determinant(const Eigen::MatrixXd& covariance, double floor_um2) {
  const Eigen::MatrixXd floored = covariance + floor_um2 * Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols());
  return 0.5 * floored.ldlt().vectorD().array().max(1e-3 * floor_um2).log().sum();
}

double n_sets(std::size_t of, std::size_t n) {
  double sets = 1.0;
  for (std::size_t k = 0; k < n; ++k) sets *= static_cast<double>(of - k) / static_cast<double>(k + 1);
  return sets;
}

/// Calls for each set of n of the list.
void for_each_set(std::span<const std::size_t> list, std::size_t n, Points& set, std::size_t from,
                  const std::function<void(const Points&)>& call) {
  if (set.size() == n) return call(set);
  for (std::size_t k = from; k + (n - set.size()) <= list.size(); ++k) {
    set.push_back(list[k]);
    for_each_set(list, n, set, k + 1, call);
    set.pop_back();
  }
}

}  // namespace

PointErrors point_errors(std::span<const Record> records) {
  PointErrors errors{.names = {}, .covariance_um2 = {}};
  for (const Channel& c : records.front().channels) {
    const bool is_common = std::all_of(records.begin(), records.end(), [&](const Record& r) {
      const Channel* other = r.find(c.name);
      return other && other->unit == "um";
    });
    if (c.unit == "um" && is_common) errors.names.push_back(c.name);
  }
  if (errors.names.size() < 2)
    throw InputError(
        fmt::format("{}: the records must share at least two displacements in um, one for each point; there {} {}",
                    records.front().source, errors.names.size() == 1 ? "is" : "are",
                    errors.names.empty() ? std::string("none") : errors.names.front()));
  const auto n = static_cast<Eigen::Index>(errors.names.size());
  errors.covariance_um2 = Eigen::MatrixXd::Zero(n, n);
  for (const Record& r : records) {
    for (std::size_t row = 0; row < r.time_s.size(); ++row) {
      Eigen::VectorXd um(n);
      for (Eigen::Index k = 0; k < n; ++k) um[k] = r.at(errors.names[static_cast<std::size_t>(k)]).values[row];
      if (!um.allFinite()) continue;
      errors.covariance_um2 += um * um.transpose();
      ++errors.n_rows;
    }
  }
  if (errors.n_rows == 0)
    throw InputError(
        fmt::format("{}: no row has a value of each of {}", records.front().source, fmt::join(errors.names, ", ")));
  errors.covariance_um2 /= static_cast<double>(errors.n_rows);
  return errors;
}

PointErrors table_point_errors(const scenarios::Scenario& scenario, std::span<const Record> records) {
  PointErrors errors{.names = {}, .covariance_um2 = {}, .n_coordinates = 3};
  for (const scenarios::TableRing& ring : scenario.table->rings) errors.names.push_back(ring.name);
  const std::size_t n_judged = static_cast<std::size_t>(scenario.table->n_x) * static_cast<std::size_t>(scenario.table->n_y);
  for (std::size_t p = 1; p <= n_judged; ++p) errors.names.push_back(fmt::format("table_{}", p));
  const auto n = static_cast<Eigen::Index>(errors.n_coordinates * errors.names.size());
  errors.covariance_um2 = Eigen::MatrixXd::Zero(n, n);
  for (const Record& record : records) {
    const TableCourse course = table_course(scenario, record);
    for (std::size_t row = 0; row < course.rings_m.size(); ++row) {
      Eigen::VectorXd um(n);
      um << 1e6 * course.rings_m[row].reshaped(), 1e6 * course.table.error_m[row].reshaped();
      if (!um.allFinite()) continue;
      errors.covariance_um2 += um * um.transpose();
      ++errors.n_rows;
    }
  }
  if (errors.n_rows == 0)
    throw InputError(fmt::format("{}: no row has a value of each point of the table", records.front().source));
  errors.covariance_um2 /= static_cast<double>(errors.n_rows);
  return errors;
}

PointSet judged_points(const PointErrors& errors, Points probed, std::span<const std::size_t> counting, double noise_um) {
  std::sort(probed.begin(), probed.end());
  const Points what_counts = coordinates_of(errors, counting);
  const Eigen::MatrixXd before = part_of(errors.covariance_um2, what_counts, what_counts);
  const Eigen::MatrixXd after = after_probing(errors, coordinates_of(errors, probed), what_counts, noise_um);
  PointSet set{.points = std::move(probed)};
  Eigen::Index worst = 0;
  set.left_um = std::sqrt(std::max(0.0, after.diagonal().mean()));
  set.worst_um = std::sqrt(std::max(0.0, after.diagonal().maxCoeff(&worst)));
  set.worst = counting[static_cast<std::size_t>(worst) / errors.n_coordinates];
  const double floor_um2 = std::max(kLeastVariance * before.diagonal().maxCoeff(), 1e-12);
  set.nats = half_log_determinant(before, floor_um2) - half_log_determinant(after, floor_um2);
  return set;
}

PointSet best_points(const PointErrors& errors, std::span<const std::size_t> probable, std::size_t n,
                     std::span<const std::size_t> counting, double noise_um, PointCriterion criterion) {
  const auto judge = [&](const Points& probed) { return judged_points(errors, probed, counting, noise_um); };
  const auto is_better = [&](const PointSet& a, const PointSet& b) {
    return criterion == PointCriterion::kMeanVariance ? a.left_um < b.left_um : a.nats > b.nats;
  };
  std::optional<PointSet> best;
  const auto take = [&](const Points& probed) {
    PointSet tried = judge(probed);
    const bool is_taken = !best || is_better(tried, *best);
    if (is_taken) best = std::move(tried);
    return is_taken;
  };
  if (n_sets(probable.size(), n) <= kMostSets) {
    Points set;
    for_each_set(probable, n, set, 0, [&](const Points& probed) { (void)take(probed); });
    return *best;
  }
  const auto has = [](const Points& set, std::size_t k) { return std::find(set.begin(), set.end(), k) != set.end(); };
  Points chosen;
  while (chosen.size() < n) {
    best.reset();
    for (std::size_t k : probable) {
      if (has(chosen, k)) continue;
      Points with = chosen;
      with.push_back(k);
      (void)take(with);
    }
    chosen = best->points;
  }
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    for (std::size_t at = 0; at < n; ++at) {
      for (std::size_t k : probable) {
        Points other = best->points;
        if (has(other, k)) continue;
        other[at] = k;
        has_changed = take(other) || has_changed;
      }
    }
  }
  return *best;
}

namespace {

/// @param option  that gave the names
Points points_named(const PointErrors& errors, const std::vector<std::string>& names, const std::string& option) {
  Points points;
  for (const std::string& name : names) {
    const auto at = std::find(errors.names.begin(), errors.names.end(), name);
    if (at == errors.names.end())
      throw InputError(fmt::format("{} '{}': the records do not share such a displacement; they share {}", option, name,
                                   fmt::join(errors.names, ", ")));
    points.push_back(static_cast<std::size_t>(at - errors.names.begin()));
  }
  for (std::size_t k = 0; names.empty() && k < errors.names.size(); ++k) points.push_back(k);
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

}  // namespace

PointChoice choose_points(PointErrors errors, const std::vector<std::string>& probable,
                          const std::vector<std::string>& counting, std::size_t n_most, double noise_um) {
  PointChoice choice{.errors = std::move(errors), .probable = {}, .counting = {}, .noise_um = noise_um};
  choice.probable = points_named(choice.errors, probable, "--may-probe");
  choice.counting = points_named(choice.errors, counting, "--counts");
  choice.without = judged_points(choice.errors, {}, choice.counting, noise_um);
  for (std::size_t n = 1; n <= std::min(n_most, choice.probable.size()); ++n) {
    const auto best = [&](PointCriterion c) {
      return best_points(choice.errors, choice.probable, n, choice.counting, noise_um, c);
    };
    choice.by_variance.push_back(best(PointCriterion::kMeanVariance));
    choice.by_determinant.push_back(best(PointCriterion::kDeterminant));
  }
  return choice;
}

}  // namespace driftwright::studies
