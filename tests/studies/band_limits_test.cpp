// Limits of functions of normal numbers from few draws, against closed forms.

#include "studies/band_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/designs.hpp"
#include "base/normal.hpp"

namespace driftwright::studies::band_limits_test {
namespace {

Eigen::MatrixXd scores(int n_draws, int n_numbers, std::uint64_t seed = 3) {
  Eigen::MatrixXd z = latin_hypercube(n_draws, n_numbers, seed);
  for (double& u : z.reshaped()) u = normal_quantile(u);
  return z;
}

TEST(BandLimits, OfALinearFunctionAreThoseOfLinearTheory) {
  const Eigen::Vector4d slope(3.0, -4.0, 0.5, 12.0);
  const double half = 1.96 * std::sqrt(9.0 + 16.0 + 0.25 + 144.0);
  for (const int n_draws : {20, 40, 200}) {  // twenty draws do not reach that far
    const Eigen::MatrixXd z = scores(n_draws, 4);
    const BandLimits limits = band_limits(z, ((z * slope).array() + 7.0).matrix());
    EXPECT_NEAR(limits.low[0], 7.0 - half, 1e-9) << n_draws;
    EXPECT_NEAR(limits.high[0], 7.0 + half, 1e-9) << n_draws;
  }
}

TEST(BandLimits, OfAMonotoneFunctionAreItsValuesAtTheLimits) {
  const Eigen::MatrixXd z = scores(80, 1);
  const double s = std::log(2.0);  // a guess: a factor of 2
  const BandLimits limits = band_limits(z, (s * z).array().exp().matrix());
  EXPECT_NEAR(limits.low[0] / std::exp(-1.96 * s), 1.0, 0.02);  // a polynomial is not quite an exponential
  EXPECT_NEAR(limits.high[0] / std::exp(1.96 * s), 1.0, 0.01);
}

// ln(p / g) is normal. A quantile of 80 draws alone errs by 20 % of the half width (one sigma).
TEST(BandLimits, OfAQuotientNeedFewDraws) {
  const double s_p = 0.3, s_g = 0.2, s = std::hypot(s_p, s_g);
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const Eigen::MatrixXd z = scores(80, 2, seed);
    const BandLimits limits = band_limits(z, (s_p * z.col(0) - s_g * z.col(1)).array().exp().matrix());
    EXPECT_NEAR(std::log(limits.low[0]) / (-kNormal95 * s), 1.0, 0.02) << seed;
    EXPECT_NEAR(std::log(limits.high[0]) / (kNormal95 * s), 1.0, 0.02) << seed;
  }
}

// A function that bends in other directions, too, and whose rest depends on the first number, which the method neglects.
// Against 200,000 draws: over ten designs of 80 draws the shares outside a limit differ from 2.5 % by less than a quantile
// of draws would, whose standard deviation is sqrt(0.025 * 0.975 / 80) = 1.7 %.
TEST(BandLimits, ErrLessThanAQuantileWhereNoDirectionHoldsTheBend) {
  const auto function = [](const Eigen::MatrixXd& z) -> Eigen::VectorXd {
    return (0.4 * z.col(0).array()).exp() * (1.0 + 0.3 * z.col(1).array()) + 0.5 * z.col(2).array() -
           0.2 * z.col(3).array().square();
  };
  const Eigen::VectorXd many = function(scores(200000, 4, 99));
  double squares = 0.0, outside = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Eigen::MatrixXd z = scores(80, 4, seed);
    const BandLimits limits = band_limits(z, function(z));
    const double below = (many.array() < limits.low[0]).cast<double>().mean();
    const double above = (many.array() > limits.high[0]).cast<double>().mean();
    squares += std::pow(below - 0.025, 2) + std::pow(above - 0.025, 2);
    outside += (below + above) / 10.0;
  }
  EXPECT_LT(std::sqrt(squares / 20.0), 0.017);
  EXPECT_NEAR(outside, 0.05, 0.015);
}

// A bend that comes and goes in time, and a slope that changes its direction: the same limits, from few of them.
TEST(BandLimits, OverTimeAreThoseOfEachTime) {
  const Eigen::MatrixXd z = scores(200, 3);
  const int n_times = 250;
  Eigen::MatrixXd values(200, n_times);
  for (int t = 0; t < n_times; ++t) {
    const double s = t / 249.0, turn = t < 101 ? 0.0 : s;
    values.col(t) = ((0.8 * s * (1.0 - s)) * (3.0 * z.col(0).array()) + turn * z.col(1).array()).exp() +
                    0.3 * s * z.col(2).array().square() + 5.0 * s;
  }
  const BandLimits each = band_limits(z, values), over_time = band_limits_over_time(z, values);
  for (int t = 0; t < n_times; ++t) {
    const double half = 0.5 * (each.high[t] - each.low[t]);
    EXPECT_NEAR(over_time.low[t], each.low[t], 0.02 * half + 1e-12) << t;
    EXPECT_NEAR(over_time.high[t], each.high[t], 0.02 * half + 1e-12) << t;
  }
  EXPECT_NEAR(band_limits_over_time(z, values.leftCols(1)).high[0], each.high[0], 1e-12);
  EXPECT_EQ(band_limits_over_time(z, Eigen::MatrixXd(200, 0)).high.size(), 0);
}

TEST(BandLimits, OfAConstantAreTheConstant) {
  const BandLimits limits = band_limits(scores(40, 3), Eigen::MatrixXd::Constant(40, 1, 5.0));
  EXPECT_NEAR(limits.low[0], 5.0, 1e-12);
  EXPECT_NEAR(limits.high[0], 5.0, 1e-12);
}

TEST(BandLimits, RefuseFewerDrawsThanNumbers) {
  EXPECT_THROW((void)band_limits(scores(4, 3), Eigen::MatrixXd::Zero(4, 1)), std::logic_error);
  EXPECT_THROW((void)band_limits(scores(10, 3), Eigen::MatrixXd::Zero(9, 1)), std::logic_error);
}

}  // namespace
}  // namespace driftwright::studies::band_limits_test
