// What a correction leaves as an Ornstein-Uhlenbeck process, and its estimate from probings, against closed forms.

#include "compensation/predictors/residual_process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

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
  ProbeFeedback feedback(p, {.noise_um = 1.0}, true);
  feedback.row(0.0, 0.0, 0.0);
  EXPECT_EQ(feedback.deviation_um(), 0.0);
  for (int k = 0; k < 50; ++k) {
    feedback.row(0.0, 0.0, 3600.0);
    if (k == 49) {
      EXPECT_NEAR(feedback.deviation_um(), std::sqrt(before), 1e-9);
    }
    EXPECT_TRUE(feedback.probe_drift_um(0.0));
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
    ProbeFeedback feedback(p, {.noise_um = 1.0}, false);
    for (std::size_t i = 0; i < truth.time_s.size(); ++i) {
      feedback.row(0.0, 0.0, 60.0);
      if (i % 60 == 0) (void)feedback.probe_drift_um(truth.off_um[i] + random.normal());
      square += std::pow(truth.off_um[i] - feedback.estimate_um(), 2);
      said += std::pow(feedback.deviation_um(), 2) / probe_scale(&feedback.state());  // 1 here, but for chance
      ++n;
    }
  }
  EXPECT_NEAR(square / said, 1.0, 0.1);
  EXPECT_LT(square / n, 0.45 * 16.0);  // 0.40 by the Riccati equation: s² - (s² - P+) (1 - exp(-1)), P+ = 0.91
}

// Errors three times as large as those of the fit: after 25 probings two thirds of the variance that is left are said, in
// place of a ninth. The rest is that of probings which are refused or count as four deviations.
TEST(ProbeFeedback, LearnsHowLargeErrorsAreInThisRun) {
  const ResidualProcess fitted{2.0, 7200.0}, truth{6.0, 7200.0};
  double square = 0.0, said = 0.0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const ResidualSeries drift = drawn(truth, 60.0, 3000, 0.0, seed);
    Random random(seed, 5);
    ProbeFeedback feedback(fitted, {.noise_um = 0.1}, false);
    for (std::size_t i = 0; i < drift.time_s.size(); ++i) {
      feedback.row(0.0, 0.0, 60.0);
      if (i % 60 == 0) (void)feedback.probe_drift_um(drift.off_um[i] + 0.1 * random.normal());
      if (i < 1500) continue;
      square += std::pow(drift.off_um[i] - feedback.estimate_um(), 2);
      said += std::pow(feedback.deviation_um(), 2);
    }
  }
  EXPECT_GT(said / square, 0.6);
  EXPECT_LT(said / square, 1.1);
}

// A calm axis says nothing of the next cut: good probings are then taken as before.
TEST(ProbeFeedback, IsNoStricterAfterACalmTime) {
  ProbeFeedback feedback({3.0, 7200.0}, {.noise_um = 1.0}, true);
  for (int hour = 0; hour < 50; ++hour) {
    feedback.row(0.0, 0.0, 3600.0);
    EXPECT_TRUE(feedback.probe_drift_um(0.0));
  }
  EXPECT_EQ(probe_scale(&feedback.state()), 1.0);
}

// Three chips in a row are taken for a jump. After them a probing may be further off than usual, by a factor of 3.5 at most;
// two good ones bring the axis back.
TEST(ProbeFeedback, ComesBackAfterThreeChipsInARow) {
  ProbeFeedback feedback({1.5, 7200.0}, {.noise_um = 1.0}, true);
  const std::vector<double> reads = {0.4, 40.0, -35.0, 60.0, 0.3, -0.2, 0.5};
  double usual_um = 0.0;
  for (std::size_t hour = 0; hour < reads.size(); ++hour) {
    feedback.row(0.0, 0.0, 3600.0);
    (void)feedback.probe_drift_um(reads[hour]);
    if (hour == 1) usual_um = feedback.state().bound_um;
    if (hour > 1) {
      EXPECT_LT(feedback.state().bound_um, 3.5 * usual_um) << hour;
    }
  }
  EXPECT_NEAR(feedback.estimate_um(), 0.2, 1.5);
}

/// A probing: when its value comes, and drift minus prediction as it reads it.
struct Read {
  double time_s, um;
};

/// Mean and variance of residual and level at a time, given probings, by the joint normal distribution of all numbers, whose
/// scale is known as from one of them and is 1 at least: no filter.
/// @param jumped_s  probings from then on read a level, too, of which nothing is known before; negative: none
std::pair<double, double> by_covariances(const ResidualProcess& p, const Probe& probe, bool is_known,
                                         const std::vector<Read>& reads, double time_s, double jumped_s = -1.0) {
  const double unknown = 1e9;
  const auto covariance = [&](double a_s, double b_s) {
    const double both =
        std::exp(-std::abs(a_s - b_s) / p.time_constant_s) - (is_known ? std::exp(-(a_s + b_s) / p.time_constant_s) : 0.0);
    return p.deviation_um * p.deviation_um * both;
  };
  const auto has_level = [&](double t_s) { return jumped_s >= 0.0 && t_s >= jumped_s ? 1.0 : 0.0; };
  const auto n = static_cast<Eigen::Index>(reads.size());
  Eigen::MatrixXd all(n, n);
  Eigen::VectorXd with(n), z(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Read& a = reads[static_cast<std::size_t>(i)];
    z[i] = a.um;
    with[i] = covariance(time_s, a.time_s - probe.lag_s) + unknown * has_level(a.time_s) * has_level(time_s);
    for (Eigen::Index j = 0; j < n; ++j) {
      const Read& b = reads[static_cast<std::size_t>(j)];
      all(i, j) = covariance(a.time_s - probe.lag_s, b.time_s - probe.lag_s) +
                  unknown * has_level(a.time_s) * has_level(b.time_s) + (i == j ? probe.noise_um * probe.noise_um : 0.0);
    }
  }
  const Eigen::VectorXd weights = all.ldlt().solve(with);
  // The first reading of the level, of which nothing is known, says nothing of the scale.
  const double n_known = static_cast<double>(n) - has_level(time_s);
  const double scale = std::max(1.0, (1.0 + z.dot(all.ldlt().solve(z))) / (1.0 + n_known));
  return {weights.dot(z), scale * (covariance(time_s, time_s) + unknown * has_level(time_s) - weights.dot(with))};
}

// Rows of 10 s; the filter answers at each as the joint distribution of all probings so far.
TEST(ProbeFeedback, IsTheConditionalDistributionOfAllProbings) {
  const ResidualProcess p{3.0, 5400.0};
  const std::vector<Read> all = {{600.0, 2.0}, {2400.0, -1.0}, {2410.0, 0.5}, {9000.0, 4.0}};
  for (const bool is_known : {false, true}) {
    for (const double lag_s : {0.0, 25.0, 400.0}) {
      const Probe probe{0.7, lag_s};
      ProbeFeedback feedback(p, probe, is_known);
      std::vector<Read> reads;
      for (int row = 0; row <= 1000; ++row) {
        const double time_s = 10.0 * row;
        feedback.row(0.0, 0.0, 10.0);
        for (const Read& read : all) {
          if (read.time_s != time_s) continue;
          EXPECT_TRUE(feedback.probe_drift_um(read.um));
          reads.push_back(read);
        }
        if (row % 7 != 0 && reads.size() == all.size()) continue;
        for (const double ahead_s : {0.0, 1800.0}) {
          const auto [mean_um, um2] = by_covariances(p, probe, is_known, reads, time_s + ahead_s);
          ASSERT_NEAR(feedback.estimate_um(ahead_s), mean_um, 1e-9) << time_s << " " << lag_s;
          ASSERT_NEAR(feedback.deviation_um(ahead_s), std::sqrt(std::max(0.0, um2)), 1e-6) << time_s << " " << lag_s;
        }
      }
    }
  }
}

// The value of a touch is compared with prediction and correction as they were at the touch, also where rows are fast.
TEST(ProbeFeedback, ComparesWithThePredictionAtTheTouch) {
  for (const double step_s : {0.5, 7.0, 60.0}) {
    ProbeFeedback drift({2.0, 1e9}, {.noise_um = 1e-3, .lag_s = 90.0}, false);
    ProbeFeedback left = drift;
    for (double t_s = 0.0; t_s <= 630.0; t_s += step_s) {  // 0.1 um a second, of which a half is corrected from row to row
      drift.row(0.1 * t_s, 0.0, step_s);
      left.row(0.1 * t_s, 0.05 * (t_s - step_s), step_s);
    }
    const double touched_s = drift.state().time_s - 90.0;
    EXPECT_TRUE(drift.probe_drift_um(0.1 * touched_s + 1.5));
    EXPECT_NEAR(drift.estimate_um(), 1.5, 1e-5) << step_s;
    EXPECT_TRUE(left.probe_left_um(0.1 * touched_s - 0.05 * step_s * std::floor(touched_s / step_s) + 1.5));
    // of fast rows those are kept that are a thirtieth of the lag apart
    EXPECT_NEAR(left.estimate_um(), 1.5, step_s < 90.0 / 30.0 ? 0.05 * 90.0 / 30.0 : 1e-5) << step_s;
  }
}

TEST(ProbeFeedback, RefusesAChipAndTakesWhatIsProbedTwice) {
  ProbeFeedback feedback({2.0, 7200.0}, {.noise_um = 0.5}, true);
  feedback.row(0.0, 0.0, 0.0);
  feedback.row(0.0, 0.0, 3600.0);
  EXPECT_TRUE(feedback.probe_drift_um(1.0));
  const double before = feedback.estimate_um();
  EXPECT_FALSE(feedback.probe_drift_um(60.0));
  EXPECT_EQ(feedback.state().verdict, PROBE_UNLIKELY);
  EXPECT_NEAR(feedback.state().off_um, 60.0 - before, 1e-12);
  EXPECT_EQ(feedback.estimate_um(), before);
  EXPECT_TRUE(feedback.probe_drift_um(0.8));  // the chip has gone
  EXPECT_FALSE(feedback.probe_drift_um(-30.0));
  EXPECT_FALSE(feedback.probe_drift_um(-60.0));  // another chip: they do not agree
  EXPECT_TRUE(feedback.probe_drift_um(0.7));
  EXPECT_FALSE(feedback.probe_drift_um(-30.0));
  EXPECT_TRUE(feedback.probe_drift_um(-30.5));
  EXPECT_EQ(feedback.state().verdict, PROBE_JUMP);
  EXPECT_NEAR(feedback.estimate_um(), -30.25, 0.01);
  EXPECT_EQ(feedback.state().n_refused, 4);
  EXPECT_EQ(feedback.state().n_jumps, 1);
}

// A drift that is faster than the process ever was is not refused for ever: each third probing is taken, and what is left
// stays below what the axis moves meanwhile.
TEST(ProbeFeedback, FollowsADriftThatIsFasterThanItsProcess) {
  ProbeFeedback feedback({2.0, 36000.0}, {.noise_um = 0.5}, true);
  double most_um = 0.0;
  for (int hour = 0; hour < 24; ++hour) {
    feedback.row(0.0, 0.0, 3600.0);
    (void)feedback.probe_drift_um(20.0 * hour);
    most_um = std::max(most_um, std::abs(20.0 * hour - feedback.estimate_um()));
  }
  EXPECT_EQ(feedback.state().n_jumps, 7);
  EXPECT_LT(most_um, 42.0);
}

// An axis that was knocked stays where it is: after a jump the filter is the joint distribution with a level of which
// nothing was known, and 10 time constants later it still expects the level.
TEST(ProbeFeedback, AJumpIsALevelThatDoesNotFade) {
  const ResidualProcess p{2.0, 3600.0};
  const Probe probe{0.5, 0.0};
  ProbeFeedback feedback(p, probe, false);
  const std::vector<Read> all = {{1200.0, 1.0}, {3000.0, 41.0}, {3600.0, 39.0}, {7200.0, 41.5}, {9000.0, 40.0}};
  std::vector<Read> reads;
  for (int row = 0; row <= 600; ++row) {
    const double time_s = 60.0 * row;
    feedback.row(0.0, 0.0, 60.0);
    for (const Read& read : all) {
      if (read.time_s != time_s) continue;
      EXPECT_EQ(feedback.probe_drift_um(read.um), read.time_s != 3000.0) << time_s;
      reads.push_back(read);
    }
    if (reads.size() < 3) continue;
    const auto [mean_um, um2] = by_covariances(p, probe, false, reads, time_s, 3000.0);
    ASSERT_NEAR(feedback.estimate_um(), mean_um, 1e-4) << time_s;  // 1e9 um² of the level cost digits
    ASSERT_NEAR(feedback.deviation_um(), std::sqrt(um2), 1e-3) << time_s;
  }
  EXPECT_GT(feedback.estimate_um(), 38.0);
}

// Two good probings after a jump disagree by more than the bound as seldom as the header says: the distance of two draws of
// the process h apart, with two noises, is within 4 deviations, and often beyond one.
TEST(ProbeFeedback, TwoProbingsAfterAJumpAgreeWithinTheBound) {
  const ResidualProcess p{3.0, 3600.0};
  int n_beyond = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    const ResidualSeries truth = drawn(p, 1800.0, 3, 0.5, seed);
    ProbeFeedback feedback(p, {.noise_um = 0.5}, false);
    for (std::size_t i = 0; i < 3; ++i) {
      feedback.row(0.0, 0.0, 1800.0);
      const bool is_taken = feedback.probe_drift_um(truth.off_um[i] + (i > 0 ? 100.0 : 0.0));
      EXPECT_EQ(is_taken, i != 1) << seed;
      const double other_um = std::sqrt(2.0 * 0.25 + 2.0 * 9.0 * (1.0 - std::exp(-0.5)));
      if (i == 2 && std::abs(truth.off_um[2] - truth.off_um[1]) > other_um) ++n_beyond;
    }
  }
  EXPECT_NEAR(n_beyond / 2000.0, 0.317, 0.032);  // three standard errors
}

TEST(ProbeFeedback, RefusesWhatIsNoProbingAndWrongSettings) {
  ProbeFeedback feedback({2.0, 7200.0}, {.noise_um = 0.5, .lag_s = 30.0}, true);
  EXPECT_FALSE(feedback.probe_drift_um(1.0));
  EXPECT_EQ(feedback.state().verdict, PROBE_TOO_EARLY);
  feedback.row(0.0, 0.0, 0.0);
  feedback.row(0.0, 0.0, 20.0);
  EXPECT_FALSE(feedback.probe_drift_um(1.0));
  EXPECT_EQ(feedback.state().verdict, PROBE_TOO_EARLY);
  feedback.row(0.0, 0.0, 20.0);
  EXPECT_FALSE(feedback.probe_drift_um(std::nan("")));
  EXPECT_EQ(feedback.state().verdict, PROBE_NO_NUMBER);
  EXPECT_TRUE(feedback.probe_drift_um(0.1));
  for (const Probe& wrong : {Probe{0.0, 0.0}, Probe{-1.0, 0.0}, Probe{std::nan(""), 0.0}, Probe{1.0, -1.0}}) {
    ProbeFeedback none({2.0, 7200.0}, wrong, true);
    none.row(0.0, 0.0, 0.0);
    EXPECT_FALSE(none.probe_drift_um(0.1));
    EXPECT_EQ(none.state().verdict, PROBE_NO_NUMBER);
    EXPECT_EQ(none.estimate_um(), 0.0);
  }
}

TEST(ProbeFeedback, GoesOnFromItsMemory) {
  ProbeFeedback whole({2.0, 7200.0}, {.noise_um = 0.5, .lag_s = 100.0}, false);
  for (int i = 0; i < 40; ++i) {
    whole.row(0.1 * i, 0.05 * i, 60.0);
    if (i % 9 == 8) (void)whole.probe_left_um(i == 17 ? 50.0 : 1.0);
  }
  ProbeFeedback second({2.0, 7200.0}, {.noise_um = 0.5, .lag_s = 100.0}, false);
  second.recall(whole.memory());
  EXPECT_EQ(second.memory(), whole.memory());
  for (ProbeFeedback* f : {&whole, &second}) {
    f->row(4.0, 2.0, 60.0);
    (void)f->probe_left_um(50.0);
    f->row(4.1, 2.1, 60.0);
    EXPECT_TRUE(f->probe_left_um(50.5));
  }
  EXPECT_EQ(second.memory(), whole.memory());
  EXPECT_THROW(second.recall(std::vector<double>(3, 0.0)), std::logic_error);
}

}  // namespace
}  // namespace driftwright::compensation::residual_process_test
