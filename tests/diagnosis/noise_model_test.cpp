// Noise of a known kind, found again beneath curves that are no noise; and whitening that whitens.

#include "diagnosis/noise_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>

namespace driftwright::diagnosis::noise_model_test {
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

TEST(Whitener, IsTheInverseRootOfTheCovarianceAcrossGapsAndUnevenRows) {
  const NoiseModel model{0.05, 0.08, 300.0};
  const std::vector<double> t = {0.0, 60.0, 90.0, 300.0, 360.0, 420.0, 1500.0, 1560.0};
  const std::vector<char> there = {1, 1, 0, 1, 1, 0, 1, 1};
  const Whitener whitener(model, t, there);
  ASSERT_EQ(whitener.n(), 6);
  Eigen::MatrixXd w(6, 6), covariance(6, 6);
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (there[i]) rows.push_back(static_cast<Eigen::Index>(i));
  }
  for (Eigen::Index a = 0; a < 6; ++a) {
    Eigen::VectorXd unit = Eigen::VectorXd::Zero(8);
    unit[rows[static_cast<std::size_t>(a)]] = 1.0;
    Eigen::VectorXd column(6);
    whitener.apply(unit, column);
    w.col(a) = column;
    for (Eigen::Index b = 0; b < 6; ++b) {
      const double apart_s = std::abs(t[static_cast<std::size_t>(rows[static_cast<std::size_t>(a)])] -
                                      t[static_cast<std::size_t>(rows[static_cast<std::size_t>(b)])]);
      covariance(a, b) = 0.08 * 0.08 * std::exp(-apart_s / 300.0) + (a == b ? 0.05 * 0.05 : 0.0);
    }
  }
  EXPECT_LT((w * covariance * w.transpose() - Eigen::MatrixXd::Identity(6, 6)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(whitener.log_determinant(), std::log(covariance.determinant()), 1e-10);
}

TEST(EstimateNoise, CountsWhatTheCurvesTake) {  // 24 curves of 60 readings: unaware of them it would say 0.155
  const std::vector<double> t = minutes(60);
  Eigen::MatrixXd curves(60, 24);
  for (Eigen::Index k = 0; k < 24; ++k) {
    for (Eigen::Index i = 0; i < 60; ++i)
      curves(i, k) = std::cos(std::numbers::pi * static_cast<double>(k) * (static_cast<double>(i) + 0.5) / 60.0);
  }
  std::vector<NoiseSeries> series;
  for (unsigned seed = 1; seed <= 20; ++seed) series.push_back({t, noise({0.2, 0.0, 0.0}, t, seed), curves});
  EXPECT_NEAR(estimate_noise(series, 1e-3).total(), 0.2, 4.0 * 0.2 / std::sqrt(2.0 * 20.0 * 36.0));  // four standard errors
}

TEST(EstimateNoise, ClaimsNoCorrelationWithoutEvidence) {
  const std::vector<double> t = minutes(300);
  int n_white = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const auto found = estimate_noise({{t, noise({0.2, 0.0, 0.0}, t, seed), Eigen::MatrixXd::Ones(300, 1)}}, 1e-3);
    n_white += found.correlated == 0.0 ? 1 : 0;
  }
  EXPECT_GE(n_white, 8);  // two nats are a false claim in some twenty
}

TEST(SmoothCurves, FollowTheDriveItsSquareAndTheirLags) {
  const std::vector<double> t = minutes(121);
  Eigen::VectorXd drive = Eigen::VectorXd::Constant(121, 0.5);
  drive.head(30).setZero();
  const Eigen::MatrixXd curves = smooth_curves(t, drive);
  // 120 min: cosines of 240 min to 40 min, the mean, and drive and square after 0, 3 and 12 min
  ASSERT_EQ(curves.cols(), 1 + 6 + 6);
  EXPECT_NEAR(curves(120, 6), 1.0, 1e-12);  // three periods of 40 min
  EXPECT_NEAR(curves(20, 6), -1.0, 1e-12);
  EXPECT_EQ(curves(60, 7), 0.5);
  EXPECT_EQ(curves(60, 10), 0.25);
  EXPECT_NEAR(curves(42, 9), 0.5 * (1.0 - std::exp(-1.0)), 1e-12);  // 12 min after the change
  EXPECT_NEAR(curves(33, 11), 0.25 * (1.0 - std::exp(-1.0)), 1e-12);
}

TEST(Telling, KeepsACurveForFourReadings) {
  const Eigen::MatrixXd curves = Eigen::MatrixXd::Ones(100, 20);
  EXPECT_EQ(telling(curves, 40).cols(), 10);
  EXPECT_EQ(telling(curves, 1000).cols(), 20);
  EXPECT_EQ(telling(curves, 2).cols(), 1);
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

TEST(EstimateNoise, FindsNoiseOfMinutesAtShortRows) {  // 6 min at rows of 15 s: 24 rows
  const NoiseModel truth{0.05, 0.05, 360.0};
  std::vector<NoiseSeries> series;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    std::vector<double> t;
    for (int i = 0; i < 1200; ++i) t.push_back(15.0 * i);
    series.push_back({t, noise(truth, t, seed), smooth_curves(t, speed_of(t))});
  }
  const NoiseModel found = estimate_noise(series, 1e-3);
  EXPECT_NEAR(found.white, truth.white, 0.05 * truth.white);
  EXPECT_NEAR(found.correlated, truth.correlated, 0.25 * truth.correlated);
  EXPECT_GT(found.time_s, 150.0);  // it had been 105 s at most
}

TEST(EstimateNoise, LeavesToTheMachineWhatItCouldFollowAtLongRows) {  // slow noise of 70 min at rows of 10 min
  std::vector<double> t;
  for (int i = 0; i < 600; ++i) t.push_back(600.0 * i);
  const NoiseModel found = estimate_noise({{t, noise({0.05, 0.1, 4200.0}, t, 3), smooth_curves(t, speed_of(t))}}, 1e-3);
  EXPECT_LE(found.time_s, 600.0);
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
}  // namespace driftwright::diagnosis::noise_model_test
