#include "diagnosis/noise_model.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/median.hpp"
#include "base/normal.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kShortestPeriod_s = 2400.0;
constexpr int kMostCosines = 24;
// Time constants of correlated noise, in rows, as far as it is faster than a machine: up to a radian of the shortest
// cosine, with margin.
constexpr double kRowsAlike[] = {1.0, 2.0, 4.0, 7.0, 12.0, 20.0, 35.0};
constexpr double kLongestAlike_s = 480.0;
constexpr int kMostJumps = 3;

/// Steps where the residual jumps far more than usual; a jump is not noise.
Eigen::MatrixXd jumps(const Eigen::VectorXd& residual) {
  std::vector<std::pair<double, Eigen::Index>> moves;
  double last = std::nan("");
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    if (std::isnan(residual[i])) continue;
    if (!std::isnan(last)) moves.emplace_back(std::abs(residual[i] - last), i);
    last = residual[i];
  }
  std::vector<double> sizes;
  for (const auto& m : moves) sizes.push_back(m.first);
  const double usual = upper_median(sizes) / kNormalMedian;
  std::sort(moves.rbegin(), moves.rend());
  std::vector<Eigen::Index> at;
  for (const auto& [size, i] : moves) {
    if (usual > 0.0 && size > 6.0 * usual && at.size() < kMostJumps) at.push_back(i);
  }
  Eigen::MatrixXd steps = Eigen::MatrixXd::Zero(residual.size(), static_cast<Eigen::Index>(at.size()));
  for (std::size_t j = 0; j < at.size(); ++j)
    steps.col(static_cast<Eigen::Index>(j)).tail(residual.size() - at[j]).setOnes();
  return steps;
}

struct Likelihood {
  double log_value = 0.0, variance = 0.0;
};

/// REML of a noise up to a factor on its variance, which is estimated.
Likelihood likelihood(const std::vector<NoiseSeries>& series, const NoiseModel& shape) {
  double squares = 0.0, log_determinants = 0.0, n_free = 0.0;
  for (const NoiseSeries& s : series) {
    const Whitener whitener(shape, s.time_s, present(s.residual));
    if (whitener.n() == 0) continue;
    Eigen::VectorXd r(whitener.n());
    whitener.apply(s.residual, r);
    Eigen::MatrixXd x(whitener.n(), s.smooth.cols());
    for (Eigen::Index c = 0; c < x.cols(); ++c) whitener.apply(s.smooth.col(c), x.col(c));
    Eigen::MatrixXd normal = x.transpose() * x;
    normal.diagonal().array() +=
        1e-9 * (normal.trace() / std::max<double>(1.0, static_cast<double>(normal.rows())) + 1e-300);
    const Eigen::LLT<Eigen::MatrixXd> factor(normal);
    const Eigen::VectorXd xr = x.transpose() * r;
    squares += r.squaredNorm() - xr.dot(factor.solve(xr));
    log_determinants += whitener.log_determinant() + 2.0 * factor.matrixLLT().diagonal().array().log().sum();
    n_free += static_cast<double>(r.size() - x.cols());
  }
  Likelihood l;
  if (n_free < 1.0) return {-1e300, 0.0};
  l.variance = std::max(squares / n_free, 1e-300);
  l.log_value = -0.5 * (n_free * std::log(l.variance) + log_determinants + n_free);
  return l;
}

}  // namespace

std::vector<char> present(const Eigen::VectorXd& series) {
  std::vector<char> there(static_cast<std::size_t>(series.size()));
  for (Eigen::Index i = 0; i < series.size(); ++i) there[static_cast<std::size_t>(i)] = !std::isnan(series[i]);
  return there;
}

double NoiseModel::total() const {
  return std::hypot(white, correlated);
}

Whitener::Whitener(const NoiseModel& noise, const std::vector<double>& time_s, const std::vector<char>& is_there) {
  const double w = noise.white * noise.white, a = noise.correlated * noise.correlated;
  double variance = a, last_s = time_s.empty() ? 0.0 : time_s.front();
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (!is_there[i]) continue;
    const double phi = a > 0.0 && noise.time_s > 0.0 ? std::exp(-(time_s[i] - last_s) / noise.time_s) : 0.0;
    variance = phi * phi * variance + a * (1.0 - phi * phi);
    const double innovation = variance + w, gain = variance / innovation;
    rows_.push_back(static_cast<Eigen::Index>(i));
    carry_.push_back(phi);
    gain_.push_back(gain);
    scale_.push_back(1.0 / std::sqrt(innovation));
    log_determinant_ += std::log(innovation);
    variance *= 1.0 - gain;
    last_s = time_s[i];
  }
}

void Whitener::apply(const Eigen::Ref<const Eigen::VectorXd>& series, Eigen::Ref<Eigen::VectorXd> out) const {
  double estimate = 0.0;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    estimate *= carry_[k];
    const double innovation = series[rows_[k]] - estimate;
    estimate += gain_[k] * innovation;
    out[static_cast<Eigen::Index>(k)] = scale_[k] * innovation;
  }
}

NoiseModel estimate_noise(const std::vector<NoiseSeries>& given, double floor) {
  std::vector<NoiseSeries> series = given;
  std::vector<double> steps_s;
  for (NoiseSeries& s : series) {
    const Eigen::MatrixXd steps = jumps(s.residual);
    s.smooth.conservativeResize(Eigen::NoChange, s.smooth.cols() + steps.cols());
    s.smooth.rightCols(steps.cols()) = steps;
    for (std::size_t i = 1; i < s.time_s.size(); ++i) steps_s.push_back(s.time_s[i] - s.time_s[i - 1]);
  }
  const double step_s = upper_median(steps_s);
  NoiseModel best{1.0, 0.0, 0.0};
  Likelihood l = likelihood(series, best);
  double best_value = l.log_value + 2.0;  // the correlation must justify its two numbers
  double scale = std::sqrt(l.variance);
  for (double rows : kRowsAlike) {
    const double time_s = rows * step_s;
    if (rows > kRowsAlike[0] && time_s > kLongestAlike_s) break;
    for (double share : {0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9}) {
      const NoiseModel shape{std::sqrt(1.0 - share), std::sqrt(share), time_s};
      l = likelihood(series, shape);
      if (!(l.log_value > best_value)) continue;
      best_value = l.log_value;
      best = shape;
      scale = std::sqrt(l.variance);
    }
  }
  return {std::max(floor, scale * best.white), scale * best.correlated, best.time_s};
}

Eigen::MatrixXd smooth_curves(const std::vector<double>& time_s, const Eigen::VectorXd& drive) {
  const auto n = static_cast<Eigen::Index>(time_s.size());
  const double length_s = time_s.back() - time_s.front();
  const int n_cosines = std::clamp(static_cast<int>(2.0 * length_s / kShortestPeriod_s), 1,
                                   std::clamp(static_cast<int>(n) / 6, 1, kMostCosines));
  const std::vector<double> lags_s = {0.0, 180.0, 720.0};
  const bool drives = n >= 60 && drive.maxCoeff() > drive.minCoeff();
  const auto n_drives = drives ? static_cast<Eigen::Index>(2 * lags_s.size()) : 0;
  Eigen::MatrixXd curves(n, 1 + n_cosines + n_drives);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double x = (time_s[static_cast<std::size_t>(i)] - time_s.front()) / length_s;
    for (int k = 0; k <= n_cosines; ++k) curves(i, k) = std::cos(std::numbers::pi * k * x);
  }
  Eigen::Index column = 1 + n_cosines;
  for (int power = 1; drives && power <= 2; ++power) {
    for (double lag_s : lags_s) {
      double lagged = 0.0;
      for (Eigen::Index i = 0; i < n; ++i) {
        const double u = std::pow(drive[i], power);
        const double dt_s = i > 0 ? time_s[static_cast<std::size_t>(i)] - time_s[static_cast<std::size_t>(i - 1)] : 0.0;
        const double before = i > 0 ? std::pow(drive[i - 1], power) : 0.0;
        lagged = lag_s > 0.0 ? before + (lagged - before) * std::exp(-dt_s / lag_s) : u;
        curves(i, column) = lagged;
      }
      ++column;
    }
  }
  return curves;
}

Eigen::MatrixXd telling(const Eigen::MatrixXd& curves, Eigen::Index n_readings) {
  return curves.leftCols(std::clamp<Eigen::Index>(n_readings / 4, 1, curves.cols()));
}

}  // namespace driftwright::diagnosis
