#include "studies/sobol_indices.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <random>
#include <stdexcept>

namespace driftwright::studies {
namespace {

constexpr int kResamples = 400;
constexpr Eigen::Index kFewestSamples = 8;

struct Shares {
  Eigen::ArrayXd first, total;
};

/// @param f  whole samples x (A, B, A with each column)
/// @param weight  how often each sample counts; they sum to the number of samples
Shares shares_of(const Eigen::ArrayXXd& f, const Eigen::ArrayXd& weight) {
  const double n = weight.sum();
  const double mean = 0.5 * (weight * (f.col(0) + f.col(1))).sum() / n;
  const Eigen::ArrayXd a = f.col(0) - mean, b = f.col(1) - mean;
  const double variance = 0.5 * (weight * (a.square() + b.square())).sum() / n;
  const Eigen::Index n_numbers = f.cols() - 2;
  Shares shares{Eigen::ArrayXd(n_numbers), Eigen::ArrayXd(n_numbers)};
  for (Eigen::Index i = 0; i < n_numbers; ++i) {
    const Eigen::ArrayXd change = f.col(2 + i) - f.col(0);
    shares.first[i] = (weight * b * change).sum() / (n * variance);
    shares.total[i] = (weight * change.square()).sum() / (2.0 * n * variance);
  }
  return shares;
}

Share share_of(double value, Eigen::ArrayXd resampled) {
  const auto at = [&](int rank) {
    std::nth_element(resampled.begin(), resampled.begin() + rank, resampled.end());
    return resampled[rank];
  };
  return {value, at(kResamples / 40), at(kResamples - 1 - kResamples / 40)};
}

}  // namespace

std::optional<std::vector<SobolIndex>> sobol_indices(const std::vector<double>& results, std::size_t n_numbers) {
  const auto n_blocks = static_cast<Eigen::Index>(n_numbers) + 2;
  const auto n_results = static_cast<Eigen::Index>(results.size());
  if (n_numbers == 0 || n_results % n_blocks != 0) throw std::logic_error("sobol_indices: no whole design");
  const Eigen::Map<const Eigen::ArrayXXd> all(results.data(), n_results / n_blocks, n_blocks);
  std::vector<Eigen::Index> whole;
  for (Eigen::Index sample = 0; sample < all.rows(); ++sample) {
    if (!all.row(sample).isNaN().any()) whole.push_back(sample);
  }
  const auto n = static_cast<Eigen::Index>(whole.size());
  if (n < kFewestSamples) return std::nullopt;
  const Eigen::ArrayXXd f = all(whole, Eigen::all);
  if (f.leftCols(2).minCoeff() == f.leftCols(2).maxCoeff()) return std::nullopt;

  const Shares best = shares_of(f, Eigen::ArrayXd::Ones(n));
  Eigen::ArrayXXd first(kResamples, n_blocks - 2), total(kResamples, n_blocks - 2);
  std::mt19937_64 random(1);
  for (int r = 0; r < kResamples; ++r) {
    Eigen::ArrayXd weight = Eigen::ArrayXd::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i) weight[static_cast<Eigen::Index>(random() % static_cast<std::uint64_t>(n))] += 1.0;
    const Shares shares = shares_of(f, weight);
    first.row(r) = shares.first;
    total.row(r) = shares.total;
  }
  std::vector<SobolIndex> indices;
  for (Eigen::Index i = 0; i < n_blocks - 2; ++i)
    indices.push_back({share_of(best.first[i], first.col(i)), share_of(best.total[i], total.col(i))});
  return indices;
}

}  // namespace driftwright::studies
