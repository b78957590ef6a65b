#include "base/normal.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"

namespace driftwright::normal_test {
namespace {

TEST(NormalQuantile, InvertsTheDistribution) {
  // Φ(x) = erfc(-x/√2)/2; relative error of p is |x| that of x for large |x|, and erfc has its own rounding: 1e-14 |x|.
  for (double x = -8.0; x <= 8.0; x += 0.37) {
    const double p = 0.5 * std::erfc(-x / std::sqrt(2.0));
    if (p < 0.999) {
      EXPECT_NEAR(normal_quantile(p), x, 1e-14 * (1.0 + std::abs(x)));
    }
  }
  EXPECT_EQ(normal_quantile(0.5), 0.0);
  EXPECT_DOUBLE_EQ(normal_quantile(0.975), 1.959963984540054);
  EXPECT_NEAR(normal_quantile(1e-300), -37.0470962993612, 1e-12);  // far in the tail; erfc there gives 1.0000e-300 back
  EXPECT_THROW((void)normal_quantile(0.0), RangeError);
  EXPECT_THROW((void)normal_quantile(1.0), RangeError);
  EXPECT_THROW((void)normal_quantile(std::nan("")), RangeError);
}

TEST(NormalConstants, AreQuantilesToTheDigitsThatTheyHave) {
  EXPECT_NEAR(kNormal95, normal_quantile(0.975), 0.5e-2);
  EXPECT_NEAR(kNormalMedian, normal_quantile(0.75), 0.5e-4);
}

}  // namespace
}  // namespace driftwright::normal_test
