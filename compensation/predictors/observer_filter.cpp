#include "compensation/predictors/observer_filter.hpp"

#include <algorithm>
#include <cmath>

#include "base/dense.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kZero = 2.0;  // possible offset of an indicator's zero, in its deviations
constexpr std::size_t kStepsKept = 512;
constexpr double kStart_K = 0.1;  // uniform uncertainty of the start state
constexpr double kWidest = 2.0;   // least range of a number over its deviation: at either end at random (Popoviciu)

}  // namespace

ObserverFilter::ObserverFilter(const solver::ReducedSystem& system, const ObserverSettings& settings, const Belief& learned,
                               Eigen::Index drift_output, bool with_drift)
    : s_(system), settings_(settings), learned_(learned), drift_output_(drift_output), with_drift_(with_drift) {
  n_ = s_.size();
  n_sources_ = static_cast<Eigen::Index>(s_.sources.size());
  n_exchanges_ = static_cast<Eigen::Index>(s_.exchanges.size());
  const Eigen::Index n_factors = learned_.mean.size(), n_all = n_ + n_factors + 1;
  scale_ = n_all - 2;
  zero_ = n_all - 1;
  belief_ = {Eigen::VectorXd::Zero(n_all), Eigen::MatrixXd::Zero(n_all, n_all)};
  belief_.covariance.topLeftCorner(n_, n_) = kStart_K * kStart_K * s_.ones * s_.ones.transpose();
  belief_.mean.segment(n_, n_factors) = learned_.mean;
  belief_.covariance.block(n_, n_, n_factors, n_factors) = learned_.covariance;
  belief_.covariance(zero_, zero_) = std::pow(kZero * 1e-6 * settings_.drift_um, 2);
  least_W_.resize(n_sources_);
  for (Eigen::Index s = 0; s < n_sources_; ++s) least_W_(s) = s_.sources[static_cast<std::size_t>(s)].power_W({});
  most_W_ = least_W_;  // at rest
}

void ObserverFilter::begin(const Eigen::VectorXd& state) {
  belief_.mean.head(n_) = state;
  start_state_ = belief_.mean.head(n_);
}

const ObserverFilter::Step& ObserverFilter::step_of(const effects::Inputs& u, double h_s) {
  Step now;
  for (const auto& source : s_.sources) now.power_W.push_back(source.power_W(u));
  for (const auto& e : s_.exchanges) now.coefficient.push_back(e.coefficient(u));
  std::vector<double> key = now.coefficient;
  key.push_back(h_s);
  key.insert(key.end(), now.power_W.begin(), now.power_W.end());
  if (steps_.size() >= kStepsKept) steps_.clear();  // intervals that never repeat
  const auto [at, is_new] = steps_.try_emplace(std::move(key), Step{});
  if (!is_new) return at->second;
  Eigen::MatrixXd k = s_.conduction;
  for (std::size_t e = 0; e < s_.exchanges.size(); ++e) k += now.coefficient[e] * s_.exchanges[e].matrix;
  const dense::SymmetricEigen eigen(k);
  Eigen::VectorXd decay(n_), gain(n_);
  for (Eigen::Index j = 0; j < n_; ++j) {
    const double x = eigen.eigenvalues()(j) * h_s;
    decay(j) = std::exp(-x);
    gain(j) = std::abs(x) > 1e-8 ? -h_s * std::expm1(-x) / x : h_s;
  }
  const Eigen::MatrixXd& v = eigen.eigenvectors();
  now.decay = v * decay.asDiagonal() * v.transpose();
  now.gain = v * gain.asDiagonal() * v.transpose();
  at->second = std::move(now);
  return at->second;
}

void ObserverFilter::step(const effects::Inputs& at, double h_s) {
  const double ambient_K = at.ambient_K;
  const Step& now = step_of(at, h_s);
  const Eigen::VectorXd z = belief_.mean.head(n_);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(n_);
  Eigen::MatrixXd by_factor(n_, n_sources_ + n_exchanges_);  // heat per unit of each factor
  for (Eigen::Index s = 0; s < n_sources_; ++s) {
    by_factor.col(s) = now.power_W[static_cast<std::size_t>(s)] * s_.sources[static_cast<std::size_t>(s)].load;
    load += by_factor.col(s);
  }
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(n_, n_);  // slope over z of the heat of the exchanges' factors
  for (Eigen::Index e = 0; e < n_exchanges_; ++e) {
    const auto& exchange = s_.exchanges[static_cast<std::size_t>(e)];
    const double c = now.coefficient[static_cast<std::size_t>(e)];
    Eigen::VectorXd outside = Eigen::VectorXd::Zero(n_);
    if (exchange.reaches_ambient()) outside += ambient_K * exchange.to_ambient;
    if (exchange.offset.size() > 0) outside += exchange.offset;
    load += c * outside;
    by_factor.col(n_sources_ + e) = c * (outside - exchange.matrix * z);
    slope -= belief_.mean(n_ + n_sources_ + e) * c * exchange.matrix;
  }
  const Eigen::Index n_factors = by_factor.cols(), n_all = belief_.mean.size();
  const Eigen::VectorXd factor = belief_.mean.segment(n_, n_factors);
  Eigen::MatrixXd f(n_, n_ + n_factors);
  f.leftCols(n_) = now.decay + now.gain * slope;
  f.rightCols(n_factors) = now.gain * by_factor;
  belief_.mean.head(n_) = now.decay * z + now.gain * (load + by_factor * factor);
  Eigen::MatrixXd& p = belief_.covariance;
  const Eigen::MatrixXd top = f * p.topRows(n_ + n_factors);  // rows of the new state over all old variables
  p.topRightCorner(n_, n_all - n_) = top.rightCols(n_all - n_);
  p.bottomLeftCorner(n_all - n_, n_) = top.rightCols(n_all - n_).transpose();
  p.topLeftCorner(n_, n_) = top.leftCols(n_ + n_factors) * f.transpose();
  forget_factors(n_factors, h_s);
  for (Eigen::Index s = 0; s < n_sources_; ++s) {
    const double power_W = now.power_W[static_cast<std::size_t>(s)];
    least_W_(s) = std::min(least_W_(s), power_W);
    most_W_(s) = std::max(most_W_(s), power_W);
  }
  if (unseen_.size() == 0) return;
  unseen_ = now.decay * unseen_;
  for (Eigen::Index s = 0; s < n_sources_; ++s)  // between the extremes of rest and of this run
    unseen_.col(s) += now.gain * s_.sources[static_cast<std::size_t>(s)].load * ((most_W_(s) - least_W_(s)) / kWidest);
}

/// Factors change at random. While the drift is measured this is a random walk; later they also return to what was
/// learned, so that none comes to be less certain than it was before learning: an Ornstein-Uhlenbeck process with the
/// variance `factor`².
void ObserverFilter::forget_factors(Eigen::Index n_factors, double h_s) {
  Eigen::MatrixXd& p = belief_.covariance;
  const double walk = std::pow(settings_.factor_walk, 2) * h_s / 3600.0, most = std::pow(settings_.factor, 2);
  if (!with_drift_ && walk < most) {
    const double kept = std::sqrt(1.0 - walk / most);
    auto mean = belief_.mean.segment(n_, n_factors);
    mean = learned_.mean.head(n_factors) + kept * (mean - learned_.mean.head(n_factors));
    p.middleRows(n_, n_factors) *= kept;
    p.middleCols(n_, n_factors) *= kept;
  }
  p.diagonal().segment(n_, n_factors).array() += walk;
}

void ObserverFilter::begin_gap() {
  unseen_ = Eigen::MatrixXd::Zero(n_, n_sources_);
}

void ObserverFilter::end_gap() {
  belief_.covariance.topLeftCorner(n_, n_) += unseen_ * unseen_.transpose();
  unseen_.resize(0, 0);
}

void ObserverFilter::correct(const Eigen::VectorXd& h, double innovation, double variance) {
  const Eigen::VectorXd ph = belief_.covariance * h;
  const double total = h.dot(ph) + variance;
  belief_.mean += ph * (innovation / total);
  belief_.covariance -= ph * ph.transpose() / total;
}

void ObserverFilter::correct_drift(double residual_m, double variance) {
  Eigen::VectorXd h = drift_gradient();
  h(zero_) = 1.0;
  correct(h, residual_m - belief_.mean(zero_), variance);
}

double ObserverFilter::reading_C(Eigen::Index output, double ambient_K) const {
  return s_.outputs.state.col(output).dot(belief_.mean.head(n_)) + s_.outputs.ambient(output) * ambient_K + s_.reference_K -
         273.15;
}

Eigen::VectorXd ObserverFilter::reading_gradient(Eigen::Index output) const {
  Eigen::VectorXd h = Eigen::VectorXd::Zero(belief_.mean.size());
  h.head(n_) = s_.outputs.state.col(output);
  return h;
}

Eigen::VectorXd ObserverFilter::outputs(double ambient_K) const {
  return s_.observe(belief_.mean.head(n_), ambient_K);
}

double ObserverFilter::unscaled_drift_m() const {
  return s_.outputs.state.col(drift_output_).dot(belief_.mean.head(n_) - start_state_);
}

double ObserverFilter::drift_m(double ambient_rise_K) const {
  return (1.0 + belief_.mean(scale_)) * unscaled_drift_m() + s_.outputs.ambient(drift_output_) * ambient_rise_K;
}

Eigen::VectorXd ObserverFilter::drift_gradient() const {
  Eigen::VectorXd h = Eigen::VectorXd::Zero(belief_.mean.size());
  h.head(n_) = (1.0 + belief_.mean(scale_)) * s_.outputs.state.col(drift_output_);
  h(scale_) = unscaled_drift_m();
  return h;
}

double ObserverFilter::variance_along(const Eigen::VectorXd& h) const {
  return h.dot(belief_.covariance * h);
}

double ObserverFilter::drift_deviation_m() const {
  return std::sqrt(std::max(0.0, variance_along(drift_gradient())));
}

Observer::Belief ObserverFilter::factors() const {
  const Eigen::Index n_factors = learned_.mean.size();
  return {belief_.mean.segment(n_, n_factors), belief_.covariance.block(n_, n_, n_factors, n_factors)};
}

std::size_t ObserverFilter::n_numbers() const {
  const auto n = belief_.mean.size();
  return static_cast<std::size_t>(2 * n_sources_ + n_ + n + n * (n + 1) / 2);
}

void ObserverFilter::add_numbers(std::vector<double>& numbers) const {
  const auto n = belief_.mean.size();
  numbers.insert(numbers.end(), least_W_.begin(), least_W_.end());
  numbers.insert(numbers.end(), most_W_.begin(), most_W_.end());
  numbers.insert(numbers.end(), start_state_.begin(), start_state_.end());
  numbers.insert(numbers.end(), belief_.mean.begin(), belief_.mean.end());
  for (Eigen::Index c = 0; c < n; ++c) {
    for (Eigen::Index r = c; r < n; ++r) numbers.push_back(belief_.covariance(r, c));
  }
}

void ObserverFilter::take_numbers(std::span<const double> numbers) {
  const auto n = belief_.mean.size();
  auto at = numbers.begin();
  for (double& w : least_W_) w = *at++;
  for (double& w : most_W_) w = *at++;
  start_state_.resize(n_);
  for (double& z : start_state_) z = *at++;
  for (double& x : belief_.mean) x = *at++;
  for (Eigen::Index c = 0; c < n; ++c) {
    for (Eigen::Index r = c; r < n; ++r) belief_.covariance(r, c) = belief_.covariance(c, r) = *at++;
  }
}

}  // namespace driftwright::compensation
