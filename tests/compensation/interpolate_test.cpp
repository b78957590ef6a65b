#include "compensation/sensors/interpolate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace driftwright::compensation::interpolate_test {
namespace {

TEST(Interpolate, IsLinearBetweenSamplesAndExactAtThem) {
  const std::vector<double> t = {0, 10, 30};
  const std::vector<double> x = {1, 2, 6};
  EXPECT_DOUBLE_EQ(interpolate(t, x, 2.5), 1.25);  // 1 + 2.5/10 * (2 - 1)
  EXPECT_DOUBLE_EQ(interpolate(t, x, 25.0), 5.0);  // 2 + 15/20 * (6 - 2)
  EXPECT_EQ(interpolate(t, x, 0.0), 1.0);
  EXPECT_EQ(interpolate(t, x, 10.0), 2.0);
  EXPECT_EQ(interpolate(t, x, 30.0), 6.0);
}

TEST(Interpolate, IsMissingOutsideAndBesideAGap) {
  const std::vector<double> t = {0, 10, 20, 30};
  const std::vector<double> x = {1, NAN, 3, 4};
  for (double outside : {-1.0, 30.5, 5.0, 10.0, 15.0, double{NAN}}) {
    EXPECT_TRUE(std::isnan(interpolate(t, x, outside))) << outside;
  }
  EXPECT_EQ(interpolate(t, x, 20.0), 3.0);  // a sample counts although its neighbour is missing
}

}  // namespace
}  // namespace driftwright::compensation::interpolate_test
