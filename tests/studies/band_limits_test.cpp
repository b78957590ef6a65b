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
  for (const int n_draws : {8, 40, 200}) {  // eight draws do not reach that far
    const Eigen::MatrixXd z = scores(n_draws, 4);
    const BandLimits limits = band_limits(z, ((z * slope).array() + 7.0).matrix());
    EXPECT_NEAR(limits.low[0], 7.0 - half, 1e-9) << n_draws;
    EXPECT_NEAR(limits.high[0], 7.0 + half, 1e-9) << n_draws;
  }
}

TEST(BandLimits, OfAMonotoneFunctionAreItsValuesAtTheLimits) {
  const Eigen::MatrixXd z = scores(200, 1);
  const double s = std::log(2.0);  // a guess: a factor of 2
  const BandLimits limits = band_limits(z, (s * z).array().exp().matrix());
  EXPECT_NEAR(limits.low[0] / std::exp(-1.96 * s), 1.0, 0.01);  // between two draws it is linear
  EXPECT_NEAR(limits.high[0] / std::exp(1.96 * s), 1.0, 0.01);
}

TEST(BandLimits, OfAQuotientAreBetterThanTheQuantilesOfTheDraws) {
  // ln(p / g) is normal; a quantile of 200 draws alone errs by 10 % of the half width (one sigma).
  const Eigen::MatrixXd z = scores(200, 2);
  const double s_p = 0.3, s_g = 0.2, s = std::hypot(s_p, s_g);
  const BandLimits limits = band_limits(z, (s_p * z.col(0) - s_g * z.col(1)).array().exp().matrix());
  EXPECT_NEAR(std::log(limits.low[0]) / (-1.96 * s), 1.0, 0.04);
  EXPECT_NEAR(std::log(limits.high[0]) / (1.96 * s), 1.0, 0.04);
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
