#include "studies/band_limits.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
#include <stdexcept>

#include "base/normal.hpp"

namespace driftwright::studies {
namespace {

/// The value among `values` whose rank is that of `limit` among `linear`, between two draws linearly, and beyond the last of
/// them as the linear part goes on.
double at_rank_of(double limit, const Eigen::VectorXd& linear, Eigen::VectorXd values) {
  double below = -std::numeric_limits<double>::infinity(), above = std::numeric_limits<double>::infinity();
  std::ptrdiff_t n_below = 0;
  for (const double u : linear) {
    if (u < limit) {
      ++n_below;
      below = std::max(below, u);
    } else {
      above = std::min(above, u);
    }
  }
  const auto first = values.begin(), last = values.end();
  if (n_below == 0) return *std::min_element(first, last) - (above - limit);
  const auto before = first + (n_below - 1);
  std::nth_element(first, before, last);
  if (n_below == values.size()) return *before + (limit - below);
  const double after = *std::min_element(before + 1, last);
  return *before + (limit - below) / (above - below) * (after - *before);
}

}  // namespace

BandLimits band_limits(const Eigen::MatrixXd& scores, const Eigen::MatrixXd& values) {
  const Eigen::Index n = scores.rows();
  if (values.rows() != n || n <= scores.cols() + 1)
    throw std::logic_error("band_limits: more draws than numbers are required, and a value for each draw");
  Eigen::MatrixXd x(n, scores.cols() + 1);
  x << Eigen::VectorXd::Ones(n), scores;
  const Eigen::MatrixXd coefficients = (x.transpose() * x).ldlt().solve(x.transpose() * values);
  const Eigen::MatrixXd linear = x * coefficients;
  BandLimits limits{Eigen::VectorXd(values.cols()), Eigen::VectorXd(values.cols())};
  for (Eigen::Index f = 0; f < values.cols(); ++f) {
    const double half = kNormal95 * coefficients.col(f).tail(scores.cols()).norm();
    limits.low[f] = at_rank_of(coefficients(0, f) - half, linear.col(f), values.col(f));
    limits.high[f] = at_rank_of(coefficients(0, f) + half, linear.col(f), values.col(f));
  }
  return limits;
}

}  // namespace driftwright::studies
