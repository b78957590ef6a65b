// Sobol' indices against closed forms.

#include "studies/sobol_indices.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "base/designs.hpp"

namespace driftwright::studies::sobol_indices_test {
namespace {

std::vector<double> results_of(int n_samples, int n_numbers, const std::function<double(const Eigen::RowVectorXd&)>& f) {
  const Eigen::MatrixXd design = saltelli_design(n_samples, n_numbers, 5);
  std::vector<double> results;
  for (Eigen::Index row = 0; row < design.rows(); ++row) results.push_back(f(design.row(row)));
  return results;
}

/// Ishigami's function of numbers in (0, 1). Source: Ishigami & Homma, Proc. ISUMA '90 (1990) 398-403.
double ishigami(const Eigen::RowVectorXd& u) {
  const auto x = [&](Eigen::Index i) { return std::numbers::pi * (2.0 * u[i] - 1.0); };
  return std::sin(x(0)) + 7.0 * std::pow(std::sin(x(1)), 2) + 0.1 * std::pow(x(2), 4) * std::sin(x(0));
}

TEST(SobolIndices, OfIshigamisFunctionAreThoseOfItsClosedForm) {
  constexpr double kA = 7.0, kB = 0.1, kPi4 = 97.40909103400244, kPi8 = kPi4 * kPi4;
  const double v1 = 0.5 * std::pow(1.0 + kB * kPi4 / 5.0, 2), v2 = kA * kA / 8.0, v13 = 8.0 * kB * kB * kPi8 / 225.0;
  const double v = v1 + v2 + v13;
  const auto indices = sobol_indices(results_of(8000, 3, ishigami), 3);
  ASSERT_TRUE(indices);
  const std::vector<double> first = {v1 / v, v2 / v, 0.0}, total = {(v1 + v13) / v, v2 / v, v13 / v};
  for (std::size_t i = 0; i < 3; ++i) {
    const SobolIndex& index = (*indices)[i];
    EXPECT_NEAR(index.first.value, first[i], 0.03) << i;  // one sigma is about 0.01 with 8000 samples
    EXPECT_NEAR(index.total.value, total[i], 0.03) << i;
    EXPECT_LT(index.first.low, index.first.value);
    EXPECT_GT(index.first.high, index.first.value);
    EXPECT_LT(index.first.high - index.first.low, 0.1) << i;
    EXPECT_LT(index.total.high - index.total.low, 0.1) << i;
  }
}

TEST(SobolIndices, OfALinearFunctionSumToOneAndHaveNoInteraction) {
  const auto indices =
      sobol_indices(results_of(2000, 3, [](const Eigen::RowVectorXd& u) { return 500.0 + 3.0 * u[0] - 4.0 * u[1]; }), 3);
  ASSERT_TRUE(indices);
  EXPECT_NEAR((*indices)[0].first.value, 9.0 / 25.0, 0.05);
  EXPECT_NEAR((*indices)[1].first.value, 16.0 / 25.0, 0.05);
  EXPECT_NEAR((*indices)[0].total.value, 9.0 / 25.0, 0.02);
  EXPECT_NEAR((*indices)[1].total.value, 16.0 / 25.0, 0.03);
  EXPECT_EQ((*indices)[2].first.value, 0.0) << "what it does not depend on";
  EXPECT_EQ((*indices)[2].total.value, 0.0);
}

TEST(SobolIndices, LeaveOutSamplesWithAMissingResult) {
  const auto f = [](const Eigen::RowVectorXd& u) { return u[0]; };
  std::vector<double> results = results_of(400, 2, f);
  results[3] = std::nan("");            // of A
  results[2 * 400 + 7] = std::nan("");  // of A with a column of B
  const auto indices = sobol_indices(results, 2);
  ASSERT_TRUE(indices);
  EXPECT_NEAR((*indices)[0].total.value, 1.0, 0.1);
  EXPECT_EQ((*indices)[1].total.value, 0.0);
}

TEST(SobolIndices, AreNoneOfAConstantAndOfTooFewSamples) {
  EXPECT_FALSE(sobol_indices(std::vector<double>(40, 3.0), 2));
  EXPECT_FALSE(sobol_indices({1, 2, 3, 4, 5, 6, 7, 8}, 2));
  EXPECT_THROW((void)sobol_indices({1, 2, 3}, 2), std::logic_error);
}

}  // namespace
}  // namespace driftwright::studies::sobol_indices_test
