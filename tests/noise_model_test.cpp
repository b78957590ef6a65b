// Noise of a known kind, found again beneath curves that are no noise; and whitening that whitens.

#include "diagnosis/noise_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace driftwright::diagnosis {
namespace {

std::vector<double> minutes(int n) {
  std::vector<double> t;
  for (int i = 0; i < n; ++i) t.push_back(60.0 * i);
  return t;
}

/// White and AR(1) noise of a seed.
Eigen::VectorXd noise(const NoiseModel& of, const std::vector<double>& time_s, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd series(static_cast<Eigen::Index>(time_s.size()));
  double slow = of.correlated * normal(random);
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (i > 0 && of.time_s > 0.0) {
      const double phi = std::exp(-(time_s[i] - time_s[i - 1]) / of.time_s);
      slow = phi * slow + of.correlated * std::sqrt(1.0 - phi * phi) * normal(random);
    }
    series[static_cast<Eigen::Index>(i)] = slow + of.white * normal(random);
  }
  return series;
}

Eigen::VectorXd speed_of(const std::vector<double>& time_s) {
  Eigen::VectorXd u(static_cast<Eigen::Index>(time_s.size()));
  for (Eigen::Index i = 0; i < u.size(); ++i) u[i] = (i / 60) % 2 == 0 ? 1.0 : 0.3;
  return u;
}

TEST(Whitener, MakesCorrelatedNoiseIndependentWithVarianceOne) {
  const NoiseModel model{0.05, 0.08, 300.0};
  const std::vector<double> t = minutes(4000);
  Eigen::VectorXd series = noise(model, t, 1);
  std::vector<char> there(t.size(), 1);
  for (std::size_t i = 100; i < 160; ++i) there[i] = 0;  // a gap
  const Whitener whitener(model, t, there);
  Eigen::VectorXd w(whitener.n());
  whitener.apply(series, w);
  const auto n = static_cast<double>(w.size());
  EXPECT_EQ(w.size(), 3940);
  EXPECT_NEAR(w.squaredNorm() / n, 1.0, 4.0 * std::sqrt(2.0 / n));  // four standard errors
  EXPECT_NEAR(w.head(w.size() - 1).dot(w.tail(w.size() - 1)) / n, 0.0, 4.0 / std::sqrt(n));
}

TEST(EstimateNoise, FindsWhiteAndCorrelatedPartBeneathADriftOfManyTimesTheirSize) {
  const NoiseModel truth{0.05, 0.05, 180.0};
  std::vector<NoiseSeries> series;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const std::vector<double> t = minutes(300);
    Eigen::VectorXd r = noise(truth, t, seed);
    for (Eigen::Index i = 0; i < r.size(); ++i)
      r[i] += 3.0 * (1.0 - std::exp(-static_cast<double>(i) / 90.0));  // 3 K of misfit
    series.push_back({t, r, smooth_curves(t, speed_of(t))});
  }
  const NoiseModel found = estimate_noise(series, 1e-3);
  EXPECT_NEAR(found.total(), truth.total(), 0.15 * truth.total());  // 900 samples, a tenth of them spent on the curves
  EXPECT_GT(found.correlated, 0.5 * truth.correlated);
}

TEST(EstimateNoise, CallsWhiteNoiseWhiteAndAStepNoNoise) {
  const NoiseModel truth{0.2, 0.0, 0.0};
  const std::vector<double> t = minutes(300);
  Eigen::VectorXd r = noise(truth, t, 5);
  r.tail(150).array() += 8.0;  // a mount that has slipped
  const NoiseModel found = estimate_noise({{t, r, smooth_curves(t, speed_of(t))}}, 1e-3);
  EXPECT_NEAR(found.total(), 0.2, 0.03);
  EXPECT_LT(found.correlated, 0.1);
}

TEST(EstimateNoise, IsNeverBelowItsFloor) {
  const std::vector<double> t = minutes(100);
  EXPECT_EQ(estimate_noise({{t, Eigen::VectorXd::Zero(100), Eigen::MatrixXd::Ones(100, 1)}}, 0.03).white, 0.03);
}

}  // namespace
}  // namespace driftwright::diagnosis
