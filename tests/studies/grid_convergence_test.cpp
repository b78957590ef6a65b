// Order, limit and error of a number on three meshes, of sequences whose limit is known.

#include "studies/grid_convergence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace driftwright::studies::grid_convergence_test {
namespace {

constexpr std::array<double, 3> kSizes = {3.1, 2.0, 1.3};  // two ratios: 1.55 and 1.538

/// f(h) = f0 + c h^p on these sizes.
std::array<double, 3> power_law(double f0, double c, double p) {
  std::array<double, 3> values{};
  for (std::size_t k = 0; k < 3; ++k) values[k] = f0 + c * std::pow(kSizes[k], p);
  return values;
}

TEST(GridConvergence, OfAPowerLawFindsItsOrderItsLimitAndItsError) {
  for (const double p : {0.6, 1.0, 2.0, 2.9}) {
    for (const double c : {0.7, -0.02}) {
      const GridConvergence found = grid_convergence(power_law(29.5, c, p), kSizes, 3.0, 0.0);
      EXPECT_EQ(found.kind, Convergence::kMonotone) << p;
      EXPECT_NEAR(found.order, p, 1e-8);
      EXPECT_NEAR(found.extrapolated, 29.5, 1e-8);
      for (std::size_t k = 0; k < 3; ++k)  // the true error is |c| h^p
        EXPECT_NEAR(found.error[k], 1.25 * std::abs(c) * std::pow(kSizes[k], p), 1e-8) << p << " " << k;
    }
  }
}

// The two finer meshes agree better than these elements can. The coarse change f3 - f2 = c h2^p (r32^p - 1) then gives the
// error c h1^p, which is larger than Celik's index by the fine change and than the true error.
TEST(GridConvergence, AboveTheHighestOrderTheErrorIsThatOfTheCoarseChange) {
  const std::array<double, 3> values = power_law(10.0, 1.0, 4.5);
  const GridConvergence found = grid_convergence(values, kSizes, 3.0, 0.0);
  EXPECT_NEAR(found.order, 4.5, 1e-8);
  EXPECT_DOUBLE_EQ(found.used_order, 3.0);
  const double celik = 1.25 * (values[1] - values[2]) / (std::pow(2.0 / 1.3, 3.0) - 1.0);
  EXPECT_NEAR(found.error[2],
              1.25 * (values[0] - values[1]) / (std::pow(3.1, 3.0) - std::pow(2.0, 3.0)) * std::pow(1.3, 3.0), 1e-10);
  EXPECT_GT(found.error[2], celik);
  EXPECT_GT(celik, 1.25 * (values[2] - 10.0));
}

TEST(GridConvergence, BelowTheLeastOrderTheErrorIsThatOfTheLeastOrder) {
  const std::array<double, 3> values = power_law(10.0, 1.0, 0.2);
  const GridConvergence found = grid_convergence(values, kSizes, 3.0, 0.0);
  EXPECT_EQ(found.kind, Convergence::kMonotone);
  EXPECT_NEAR(found.order, 0.2, 1e-8);
  EXPECT_DOUBLE_EQ(found.used_order, 0.5);
  EXPECT_NEAR(found.error[2], 1.25 * (values[1] - values[2]) / (std::sqrt(2.0 / 1.3) - 1.0), 1e-10);
}

// 2, 5, 4: up by 3, down by 1. The range is 3.
TEST(GridConvergence, OfAnOscillationHasNoOrderAndTheErrorOfItsRange) {
  const GridConvergence found = grid_convergence({2.0, 5.0, 4.0}, kSizes, 3.0, 0.0);
  EXPECT_EQ(found.kind, Convergence::kOscillating);
  EXPECT_TRUE(std::isnan(found.order));
  EXPECT_TRUE(std::isnan(found.extrapolated));
  for (double error : found.error) EXPECT_DOUBLE_EQ(error, 3.75);
}

// A law h^-1 changes more from mesh to mesh the finer they are.
TEST(GridConvergence, OfChangesThatGrowHasNoLimit) {
  const GridConvergence found = grid_convergence(power_law(10.0, 1.0, -1.0), kSizes, 3.0, 0.0);
  EXPECT_EQ(found.kind, Convergence::kGrowing);
  EXPECT_NEAR(found.order, -1.0, 1e-8);
  EXPECT_TRUE(std::isnan(found.extrapolated));
  EXPECT_DOUBLE_EQ(found.used_order, 0.5);
  EXPECT_GT(found.error[2], 0.0);
  const GridConvergence late = grid_convergence({5.0, 5.0, 6.0}, kSizes, 3.0, 0.0);
  EXPECT_EQ(late.kind, Convergence::kGrowing) << "no change, then one";
  EXPECT_TRUE(std::isnan(late.order));
}

TEST(GridConvergence, OfEqualValuesIsUnresolved) {
  for (const double resolution : {0.0, 0.04}) {
    const GridConvergence found = grid_convergence({7.0, 7.0, 7.0}, kSizes, 3.0, resolution);
    EXPECT_EQ(found.kind, Convergence::kUnresolved);
    for (double error : found.error) EXPECT_EQ(error, resolution);
  }
  EXPECT_EQ(grid_convergence({7.0, 7.03, 7.01}, kSizes, 3.0, 0.04).kind, Convergence::kUnresolved);
  EXPECT_EQ(grid_convergence({7.0, 7.05, 7.01}, kSizes, 3.0, 0.04).kind, Convergence::kOscillating);
  const GridConvergence settled = grid_convergence({6.0, 7.0, 7.0}, kSizes, 3.0, 0.0);
  EXPECT_EQ(settled.kind, Convergence::kMonotone) << "a change, then none";
  EXPECT_EQ(settled.extrapolated, 7.0);
  EXPECT_NEAR(settled.error[2], 1.25 / (std::pow(3.1, 3.0) - std::pow(2.0, 3.0)) * std::pow(1.3, 3.0), 1e-12);
}

TEST(GridConvergence, RefusesSizesThatDoNotDecrease) {
  EXPECT_THROW((void)grid_convergence({1.0, 2.0, 3.0}, {1.0, 2.0, 3.0}, 3.0, 0.0), std::logic_error);
  EXPECT_THROW((void)grid_convergence({1.0, 2.0, 3.0}, {2.0, 1.0, 0.0}, 3.0, 0.0), std::logic_error);
}

}  // namespace
}  // namespace driftwright::studies::grid_convergence_test
