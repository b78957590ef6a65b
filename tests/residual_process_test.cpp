// What a correction leaves as an Ornstein-Uhlenbeck process, and its estimate from probings, against closed forms.

#include "compensation/predictors/residual_process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"

namespace driftwright::compensation::residual_process_test {
namespace {

/// A draw of the process at equal steps, read with noise.
ResidualSeries drawn(const ResidualProcess& p, double step_s, std::size_t n, double reading_um, std::uint64_t seed) {
  Random random(seed, 3);
  ResidualSeries s;
  const double kept = std::exp(-step_s / p.time_constant_s);
  double um = p.deviation_um * random.normal();
  for (std::size_t i = 0; i < n; ++i) {
    s.time_s.push_back(static_cast<double>(i) * step_s);
    s.off_um.push_back(um + reading_um * random.normal());
    um = kept * um + p.deviation_um * std::sqrt(1.0 - kept * kept) * random.normal();
  }
  return s;
}

// 10 series of 20 time constants each are some 100 independent values: three standard errors of the deviation are 21 %,
// and a step of the grid is 15 %.
TEST(ResidualProcess, IsFoundInItsOwnDraws) {
  for (const ResidualProcess truth : {ResidualProcess{3.0, 3600.0}, ResidualProcess{0.8, 1200.0}}) {
    std::vector<ResidualSeries> series;
    for (std::uint64_t seed = 1; seed <= 10; ++seed)
      series.push_back(drawn(truth, 60.0, static_cast<std::size_t>(20.0 * truth.time_constant_s / 60.0), 0.5, seed));
    const std::optional<ResidualProcess> found = fit_residual_process(series, 0.5);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->deviation_um, truth.deviation_um, 0.25 * truth.deviation_um);
    EXPECT_NEAR(std::log(found->time_constant_s / truth.time_constant_s), 0.0, std::log(1.34));
  }
}

TEST(ResidualProcess, AnOffsetHasALongTimeConstant) {
  ResidualSeries s = drawn({1e-3, 60.0}, 60.0, 300, 0.5, 4);
  for (double& um : s.off_um) um += 8.0;
  const std::optional<ResidualProcess> found = fit_residual_process(std::vector<ResidualSeries>{s}, 0.5);
  ASSERT_TRUE(found);
  EXPECT_GT(found->time_constant_s, 5.0 * s.time_s.back());
  EXPECT_FALSE(fit_residual_process(std::vector<ResidualSeries>{{{0.0, 60.0}, {1.0, 1.0}}}, 0.5));
}

// Before each of many probings the variance is that of the stationary Riccati equation of a scalar:
// P = a² P R / (P + R) + (1 - a²) s².
TEST(ProbeFeedback, ItsDeviationIsThatOfTheRiccatiEquation) {
  const ResidualProcess p{4.0, 7200.0};
  const double a2 = std::exp(-2.0 * 3600.0 / 7200.0), r = 1.0, q = (1.0 - a2) * 16.0;
  const double b = r * (1.0 - a2) - q, before = 0.5 * (-b + std::sqrt(b * b + 4.0 * q * r));
  ProbeFeedback feedback(p, true);
  EXPECT_EQ(feedback.deviation_um(), 0.0);
  for (int k = 0; k < 50; ++k) {
    feedback.wait(3600.0);
    if (k == 49) {
      EXPECT_NEAR(feedback.deviation_um(), std::sqrt(before), 1e-9);
    }
    EXPECT_TRUE(feedback.probe(0.0, 1.0));
  }
}

// The share of the variance that is left over many hours agrees with the filter's own.
TEST(ProbeFeedback, LeavesAsMuchAsItSays) {
  const ResidualProcess p{4.0, 7200.0};
  double square = 0.0, said = 0.0;
  int n = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const ResidualSeries truth = drawn(p, 60.0, 3000, 0.0, seed);
    Random random(seed, 5);
    ProbeFeedback feedback(p, false);
    for (std::size_t i = 0; i < truth.time_s.size(); ++i) {
      if (i > 0) feedback.wait(60.0);
      if (i % 60 == 0) (void)feedback.probe(truth.off_um[i] + random.normal(), 1.0);
      square += std::pow(truth.off_um[i] - feedback.estimate_um(), 2);
      said += std::pow(feedback.deviation_um(), 2);
      ++n;
    }
  }
  EXPECT_NEAR(square / said, 1.0, 0.1);
  EXPECT_LT(square / n, 0.45 * 16.0);  // 0.40 by the Riccati equation: s² - (s² - P+) (1 - exp(-1)), P+ = 0.91
}

TEST(ProbeFeedback, RefusesAChipAndTakesWhatIsProbedTwice) {
  ProbeFeedback feedback({2.0, 7200.0}, true);
  feedback.wait(3600.0);
  EXPECT_TRUE(feedback.probe(1.0, 0.5));
  const double before = feedback.estimate_um();
  EXPECT_FALSE(feedback.probe(60.0, 0.5));
  EXPECT_EQ(feedback.estimate_um(), before);
  EXPECT_TRUE(feedback.probe(0.8, 0.5));  // the chip has gone
  EXPECT_FALSE(feedback.probe(-30.0, 0.5));
  EXPECT_TRUE(feedback.probe(-30.5, 0.5));
  EXPECT_NEAR(feedback.estimate_um(), -30.5, 0.5);
}

}  // namespace
}  // namespace driftwright::compensation::residual_process_test
