#include "studies/band_limits.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "base/normal.hpp"
#include "base/parallel.hpp"

namespace driftwright::studies {
namespace {

constexpr int kBendTerms = 6;            // coefficients of g
constexpr std::size_t kBendNodes = 64;   // of g; they reach 2.66 sigma, beyond which g goes on as a straight line
constexpr double kLinearShare = 1e-3;    // residual that counts as none, in half widths: at a limit it is 0.3 % at most
constexpr double kResidualShare = 0.03;  // residual that widens the band by 0.2 %: 0.5 (1.96 * 0.03)^2
constexpr int kMostSteps = 3;            // of Gauss and Newton
constexpr double kStepGain = 0.9;        // a step that leaves more of the residual is the last
constexpr double kScoreError = 1e-3;     // of a solved limit, in sigma: 0.05 % of the half width

using Bend = Eigen::Matrix<double, kBendTerms, 1>;

double normal_probability(double score) {
  return 0.5 * std::erfc(-score / std::sqrt(2.0));
}

/// The distribution of g(u), u standard normal, plus one of the residuals with equal probability.
class BentDistribution {
 public:
  BentDistribution(const Bend& g, Eigen::VectorXd residuals) : residuals_(std::move(residuals)) {
    for (std::size_t k = 0; k < kBendNodes; ++k) {
      u_[k] = normal_quantile((static_cast<double>(k) + 0.5) / static_cast<double>(kBendNodes));
      y_[k] = 0.0;
      for (int p = kBendTerms - 1; p >= 0; --p) y_[k] = y_[k] * u_[k] + g[p];
    }
    std::sort(y_.begin(), y_.end());  // values of a function that turns back have the same distribution in order
  }

  /// The value that a share of it lies below. @param score  of that share
  [[nodiscard]] double limit(double score) const {
    double low = -std::numeric_limits<double>::infinity(), high = -low;
    const double slope = (y_.back() - y_.front()) / (u_.back() - u_.front());
    double step_per_score = std::max(std::hypot(slope, sd()), std::numeric_limits<double>::min());
    double y = at(score) + residuals_.mean(), before = y, score_before = 0.0;
    for (int i = 0; i < 40; ++i) {
      const double here = score_at(y);
      if (std::abs(here - score) < kScoreError) break;
      (here < score ? low : high) = y;
      if (i > 0 && std::abs(here - score_before) > 1e-9) step_per_score = (y - before) / (here - score_before);
      before = y;
      score_before = here;
      y += (score - here) * step_per_score;
      if (!(y > low && y < high)) y = std::isfinite(low) && std::isfinite(high) ? 0.5 * (low + high) : y;
    }
    return y;
  }

  /// g at a score.
  [[nodiscard]] double at(double score) const {
    const auto k = upper(std::upper_bound(u_.begin(), u_.end(), score) - u_.begin());
    return y_[k - 1] + (score - u_[k - 1]) / (u_[k] - u_[k - 1]) * (y_[k] - y_[k - 1]);
  }

 private:
  static std::size_t upper(std::ptrdiff_t k) {
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k, 1, static_cast<std::ptrdiff_t>(kBendNodes) - 1));
  }
  [[nodiscard]] double sd() const { return residuals_.norm() / std::sqrt(static_cast<double>(residuals_.size())); }

  /// Score of the share that lies below y, within 7 sigma.
  [[nodiscard]] double score_at(double y) const {
    double share = 0.0;
    for (const double r : residuals_) {
      const auto k = upper(std::upper_bound(y_.begin(), y_.end(), y - r) - y_.begin());
      const double rise = y_[k] - y_[k - 1];
      const double part = rise > 0.0 ? (y - r - y_[k - 1]) / rise : (y - r < y_[k] ? -1e3 : 1e3);
      share += normal_probability(u_[k - 1] + part * (u_[k] - u_[k - 1]));
    }
    return normal_quantile(std::clamp(share / static_cast<double>(residuals_.size()), 1e-12, 1.0 - 1e-12));
  }

  std::array<double, kBendNodes> u_{}, y_{};
  Eigen::VectorXd residuals_;
};

/// Powers of u, the constant first.
Eigen::MatrixXd powers(const Eigen::VectorXd& u) {
  Eigen::MatrixXd v(u.size(), kBendTerms);
  v.col(0).setOnes();
  for (int k = 1; k < kBendTerms; ++k) v.col(k) = v.col(k - 1).cwiseProduct(u);
  return v;
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& x, const Eigen::VectorXd& y) {
  // the direction's length is free in one column of a Gauss-Newton step; the small diagonal chooses the shortest step
  const Eigen::MatrixXd square =
      x.transpose() * x + 1e-8 * static_cast<double>(x.rows()) * Eigen::MatrixXd::Identity(x.cols(), x.cols());
  return square.ldlt().solve(x.transpose() * y);
}

/// Limits of a function of slope 1 in the direction of its linear part.
std::pair<double, double> bent_limits(const Eigen::MatrixXd& scores, Eigen::VectorXd direction, const Eigen::VectorXd& y) {
  Eigen::VectorXd u = scores * direction;
  Eigen::MatrixXd v = powers(u);
  Bend g = least_squares(v, y);
  Eigen::VectorXd residuals = y - v * g;
  Eigen::MatrixXd step(scores.rows(), kBendTerms + scores.cols());
  const auto n = static_cast<double>(y.size());
  const double small = kResidualShare * kNormal95 * std::sqrt(n);
  for (int i = 0; i < kMostSteps && residuals.norm() > small; ++i) {
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(u.size());
    for (int p = 1; p < kBendTerms; ++p) slope += p * g[p] * v.col(p - 1);
    step << v, (scores.array().colwise() * slope.array()).matrix();
    const Eigen::VectorXd next = (direction + least_squares(step, residuals).tail(scores.cols())).normalized();
    const Eigen::VectorXd next_u = scores * next;
    const Eigen::MatrixXd next_v = powers(next_u);
    const Bend next_g = least_squares(next_v, y);
    const Eigen::VectorXd left = y - next_v * next_g;
    const double share = left.norm() / residuals.norm();
    if (!(share < 1.0)) break;
    direction = next;
    u = next_u;
    v = next_v;
    g = next_g;
    residuals = left;
    if (share > kStepGain) break;
  }
  residuals *= std::sqrt(n / (n - static_cast<double>(scores.cols() + kBendTerms - 1)));
  const BentDistribution whole(g, residuals);
  const double low = whole.at(-kNormal95), high = whole.at(kNormal95);
  if (residuals.norm() / std::sqrt(n) < kResidualShare * 0.5 * (high - low)) return {low, high};
  return {whole.limit(-kNormal95), whole.limit(kNormal95)};
}

}  // namespace

Eigen::Index fewest_draws(Eigen::Index n_numbers) {
  return 2 * (n_numbers + kBendTerms);
}

BandLimits band_limits(const Eigen::MatrixXd& scores, const Eigen::MatrixXd& values) {
  const Eigen::Index n = scores.rows();
  if (values.rows() != n || n < fewest_draws(scores.cols()))
    throw std::logic_error("band_limits: more draws than numbers are required, and a value for each draw");
  Eigen::MatrixXd x(n, scores.cols() + 1);
  x << Eigen::VectorXd::Ones(n), scores;
  const Eigen::MatrixXd coefficients = (x.transpose() * x).ldlt().solve(x.transpose() * values);
  BandLimits limits{Eigen::VectorXd(values.cols()), Eigen::VectorXd(values.cols())};
  parallel_for(static_cast<std::size_t>(values.cols()), [&](std::size_t function) {
    const auto f = static_cast<Eigen::Index>(function);
    const double middle = coefficients(0, f), slope = coefficients.col(f).tail(scores.cols()).norm();
    const Eigen::VectorXd linear = x * coefficients.col(f);
    const double residual = (values.col(f) - linear).norm() / std::sqrt(static_cast<double>(n));
    const double rounding = 1e-12 * values.col(f).cwiseAbs().maxCoeff();
    std::pair<double, double> ends(-kNormal95, kNormal95);
    if (residual > kLinearShare * kNormal95 * slope + rounding && slope > rounding)
      ends = bent_limits(scores, coefficients.col(f).tail(scores.cols()) / slope,
                         ((values.col(f).array() - middle) / slope).matrix());
    limits.low[f] = middle + slope * ends.first;
    limits.high[f] = middle + slope * ends.second;
  });
  return limits;
}

}  // namespace driftwright::studies
