#include "compensation/sensors/ranking_stability.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/random.hpp"

namespace driftwright::compensation {
namespace {

constexpr Eigen::Index kBlocksPerRecord = 20;

/// Rows by falling grade.
std::vector<std::size_t> order_of(const Eigen::VectorXd& grades) {
  std::vector<std::size_t> order(static_cast<std::size_t>(grades.size()));
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return grades(static_cast<Eigen::Index>(a)) > grades(static_cast<Eigen::Index>(b));
  });
  return order;
}

struct Block {
  Eigen::Index from = 0, n = 0;
};
std::vector<Block> blocks_of(const std::vector<Eigen::Index>& first) {
  std::vector<Block> blocks;
  for (std::size_t r = 0; r + 1 < first.size(); ++r) {
    const Eigen::Index n = first[r + 1] - first[r], length = std::max<Eigen::Index>(1, n / kBlocksPerRecord);
    for (Eigen::Index at = 0; at < n; at += length) blocks.push_back({first[r] + at, std::min(length, n - at)});
  }
  return blocks;
}

/// Deng's grades over drawn blocks, from the distances of all rows.
Eigen::VectorXd resampled_grades(const Eigen::MatrixXd& distance, const std::vector<Block>& drawn, double rho) {
  double smallest = INFINITY, largest = 0.0, n = 0.0;
  for (const Block& b : drawn) {
    const auto rows = distance.middleRows(b.from, b.n);
    smallest = std::min(smallest, rows.minCoeff());
    largest = std::max(largest, rows.maxCoeff());
    n += static_cast<double>(b.n);
  }
  if (largest == 0.0) return Eigen::VectorXd::Ones(distance.cols());
  const double floor = rho * largest;
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(distance.cols());
  for (const Block& b : drawn) {
    sum += ((smallest + floor) / (distance.middleRows(b.from, b.n).array() + floor)).colwise().sum().matrix();
  }
  return sum.transpose() / n;
}

double quantile(std::vector<double> x, double share) {
  std::sort(x.begin(), x.end());
  return x[static_cast<std::size_t>(std::lround(share * static_cast<double>(x.size() - 1)))];
}

}  // namespace

RankingStability ranking_stability(std::span<const Record> records, const std::string& reference,
                                   const std::vector<std::string>& candidates, const GreyOptions& options, int n,
                                   int n_resamples, std::uint64_t seed) {
  const GreyImages images = grey_images(records, reference, candidates, options);
  std::vector<Eigen::Index> kept;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (images.note[i].empty()) kept.push_back(static_cast<Eigen::Index>(i));
  }
  RankingStability result{.channels = {}, .n_resamples = n_resamples, .by_rho = {}, .undecided = {}};
  if (kept.empty()) return result;
  const Eigen::MatrixXd of_all = images.candidates(Eigen::all, kept);
  const Eigen::MatrixXd distance = (of_all.colwise() - images.reference.col(0)).cwiseAbs();
  const auto name = [&](std::size_t k) { return candidates[static_cast<std::size_t>(kept[k])]; };
  const std::size_t m = kept.size(), n_best = std::min(m, static_cast<std::size_t>(n));
  for (int tenth = 1; tenth <= 10; ++tenth) {
    const double rho = 0.1 * tenth;
    const std::vector<std::size_t> order = order_of(deng_grades(images.reference, of_all, rho));
    auto& [_, names] = result.by_rho.emplace_back(rho, std::vector<std::string>{});
    for (std::size_t k = 0; k < n_best; ++k) names.push_back(name(order[k]));
  }

  const std::vector<Block> blocks = blocks_of(images.first);
  Random random(seed, 17);
  std::vector<std::vector<double>> rank(m);
  Eigen::MatrixXd grades(static_cast<Eigen::Index>(m), n_resamples);
  for (int s = 0; s < n_resamples; ++s) {
    std::vector<Block> drawn;
    for (std::size_t b = 0; b < blocks.size(); ++b) drawn.push_back(random.one_of(blocks));
    grades.col(s) = resampled_grades(distance, drawn, options.rho);
    const std::vector<std::size_t> order = order_of(grades.col(s));
    for (std::size_t k = 0; k < m; ++k) rank[order[k]].push_back(static_cast<double>(k + 1));
  }
  const auto deviation = [&](const Eigen::RowVectorXd& x) { return std::sqrt((x.array() - x.mean()).square().mean()); };
  const std::vector<std::size_t> order = order_of(deng_grades(images.reference, of_all, options.rho));
  for (std::size_t k = 0; k < m; ++k) {
    const std::size_t i = order[k];
    const auto chosen =
        std::count_if(rank[i].begin(), rank[i].end(), [&](double r) { return r <= static_cast<double>(n_best); });
    result.channels.push_back({name(i), quantile(rank[i], 0.05), quantile(rank[i], 0.95),
                               static_cast<double>(chosen) / n_resamples,
                               deviation(grades.row(static_cast<Eigen::Index>(i)))});
    if (k == 0) continue;
    const Eigen::RowVectorXd gap =
        grades.row(static_cast<Eigen::Index>(order[k - 1])) - grades.row(static_cast<Eigen::Index>(i));
    if (std::abs(gap.mean()) <= 2.0 * deviation(gap)) result.undecided.emplace_back(name(order[k - 1]), name(i));
  }
  return result;
}

}  // namespace driftwright::compensation
