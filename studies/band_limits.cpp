#include "studies/band_limits.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/normal.hpp"
#include "base/parallel.hpp"

namespace driftwright::studies {
namespace {

constexpr int kBendTerms = 6;              // coefficients of g
constexpr std::size_t kBendNodes = 64;     // of g; they reach 2.66 sigma, beyond which g goes on as a straight line
constexpr double kLinearShare = 1e-3;      // residual that counts as none, in half widths: at a limit it is 0.3 % at most
constexpr double kResidualShare = 0.03;    // residual that widens the band by 0.2 %: 0.5 (1.96 * 0.03)^2
constexpr int kMostSteps = 3;              // of Gauss and Newton
constexpr double kStepGain = 0.9;          // a step that leaves more of the residual is the last
constexpr double kScoreError = 1e-3;       // of a solved limit, in sigma: 0.05 % of the half width
constexpr Eigen::Index kTimesBetween = 8;  // of two times whose limits are computed, at first
constexpr double kLineError = 0.01;        // of limits between two times, in half widths

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

namespace {

/// Limits of functions, of which each is computed at most once.
class Limits {
 public:
  Limits(const Eigen::MatrixXd& scores, const Eigen::MatrixXd& values) : scores_(scores), values_(values) {
    const Eigen::Index n = scores.rows();
    if (values.rows() != n || n < fewest_draws(scores.cols()))
      throw std::logic_error("band_limits: more draws than numbers are required, and a value for each draw");
    Eigen::MatrixXd x(n, scores.cols() + 1);
    x << Eigen::VectorXd::Ones(n), scores;
    coefficients_ = (x.transpose() * x).ldlt().solve(x.transpose() * values);
    residuals_ = values - x * coefficients_;
    slope_ = coefficients_.bottomRows(scores.cols()).colwise().norm();
    ends_.resize(2, values.cols());
  }

  /// Computes the limits of these functions.
  void compute(const std::vector<Eigen::Index>& functions) {
    parallel_for(functions.size(), [&](std::size_t i) { ends_.col(functions[i]) = ends_of(functions[i]); });
  }
  /// Limits from the middle, in slopes; they may be set instead of computed.
  [[nodiscard]] auto ends(Eigen::Index function) { return ends_.col(function); }

  [[nodiscard]] BandLimits all() const {
    const Eigen::MatrixXd at = (ends_.array().rowwise() * slope_.array()).rowwise() + coefficients_.row(0).array();
    return {at.row(0), at.row(1)};
  }

 private:
  [[nodiscard]] Eigen::Vector2d ends_of(Eigen::Index f) const {
    const double slope = slope_[f], rounding = 1e-12 * values_.col(f).cwiseAbs().maxCoeff();
    const double residual = residuals_.col(f).norm() / std::sqrt(static_cast<double>(scores_.rows()));
    if (!(residual > kLinearShare * kNormal95 * slope + rounding && slope > rounding)) return {-kNormal95, kNormal95};
    const auto [low, high] = bent_limits(scores_, coefficients_.col(f).tail(scores_.cols()) / slope,
                                         ((values_.col(f).array() - coefficients_(0, f)) / slope).matrix());
    return {low, high};
  }

  const Eigen::MatrixXd &scores_, &values_;
  Eigen::MatrixXd coefficients_, residuals_;
  Eigen::RowVectorXd slope_;
  Eigen::Matrix2Xd ends_;
};

}  // namespace

BandLimits band_limits(const Eigen::MatrixXd& scores, const Eigen::MatrixXd& values) {
  Limits limits(scores, values);
  std::vector<Eigen::Index> all(static_cast<std::size_t>(values.cols()));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  limits.compute(all);
  return limits.all();
}

BandLimits band_limits_over_time(const Eigen::MatrixXd& scores, const Eigen::MatrixXd& values) {
  Limits limits(scores, values);
  const Eigen::Index last = values.cols() - 1;
  struct Span {
    Eigen::Index from, to;
    [[nodiscard]] Eigen::Index middle() const { return (from + to) / 2; }
  };
  std::vector<Span> open;
  std::vector<Eigen::Index> times;
  for (Eigen::Index t = 0; t <= last; t = t < last ? std::min(t + kTimesBetween, last) : last + 1) {
    if (!times.empty()) open.push_back({times.back(), t});
    times.push_back(t);
  }
  limits.compute(times);
  while (!open.empty()) {
    std::erase_if(open, [](const Span& s) { return s.to - s.from < 2; });
    times.clear();
    for (const Span& s : open) times.push_back(s.middle());
    limits.compute(times);
    std::vector<Span> halves;
    for (const Span& s : open) {
      const Eigen::Index m = s.middle();
      const auto between = [&](Eigen::Index a, Eigen::Index b, Eigen::Index t) -> Eigen::Vector2d {
        const double share = static_cast<double>(t - a) / static_cast<double>(b - a);
        return (1.0 - share) * limits.ends(a) + share * limits.ends(b);
      };
      const bool is_line = (between(s.from, s.to, m) - limits.ends(m)).cwiseAbs().maxCoeff() <= kLineError * kNormal95;
      for (const Span& half : {Span{s.from, m}, Span{m, s.to}}) {
        if (!is_line) halves.push_back(half);
        for (Eigen::Index t = half.from + 1; is_line && t < half.to; ++t) limits.ends(t) = between(half.from, half.to, t);
      }
    }
    open = std::move(halves);
  }
  return limits.all();
}

}  // namespace driftwright::studies
