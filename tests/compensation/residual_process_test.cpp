// What a correction leaves as an Ornstein-Uhlenbeck process, and its estimate from probings, against closed forms.

#include "compensation/predictors/residual_process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
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

// Before each of many probings the variance of each filter of the bank is that of the stationary Riccati equation of a
// scalar: P = a² P R / (P + R) + (1 - a²) s².
TEST(ProbeFeedback, ItsVariancesAreThoseOfTheRiccatiEquation) {
  const ResidualProcess p{4.0, 7200.0};
  ProbeFeedback feedback(p, {.noise_um = 1.0}, true);
  feedback.row(0.0, 0.0, 0.0);
  EXPECT_EQ(feedback.deviation_um(), 0.0);
  for (int k = 0; k < 400; ++k) {
    feedback.row(0.0, 0.0, 3600.0);
    if (k < 399) {
      EXPECT_TRUE(feedback.probe_drift_um(0.0));
    }
  }
  double mean_um2 = 0.0, sum = 0.0;
  int k = 0;
  for (const double size : {1.0 / 3.0, 1.0, 3.0, 9.0}) {
    for (const double time : {0.25, 1.0, 4.0, 16.0}) {
      const probe_estimate& e = feedback.state().now[k++];
      const double a2 = std::exp(-2.0 * 3600.0 / (7200.0 * time)), q = (1.0 - a2) * 16.0 * size * size, r = 1.0;
      const double b = r * (1.0 - a2) - q, before = 0.5 * (-b + std::sqrt(b * b + 4.0 * q * r));
      EXPECT_NEAR(e.residual_um2, before, 1e-9 * before) << size << " " << time;
      mean_um2 += e.weight * before;
      sum += e.weight;
    }
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_NEAR(feedback.deviation_um(), std::sqrt(mean_um2), 1e-9);  // all expect 0
}

/// What is left of draws of a process by the filter of a fit, from row 1500 of 3000 on, with a probing each hour: mean
/// square, and that which the filter says.
struct LeftOfDraws {
  double um2 = 0.0, said_um2 = 0.0;
};
LeftOfDraws left_of_draws(const ResidualProcess& fitted, const ResidualProcess& truth, double noise_um) {
  LeftOfDraws left;
  int n = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const ResidualSeries drift = drawn(truth, 60.0, 3000, 0.0, seed);
    Random random(seed, 5);
    ProbeFeedback feedback(fitted, {.noise_um = noise_um}, false);
    for (std::size_t i = 0; i < drift.time_s.size(); ++i) {
      feedback.row(0.0, 0.0, 60.0);
      if (i % 60 == 0) (void)feedback.probe_drift_um(drift.off_um[i] + noise_um * random.normal());
      if (i < 1500) continue;
      left.um2 += std::pow(drift.off_um[i] - feedback.estimate_um(), 2);
      left.said_um2 += std::pow(feedback.deviation_um(), 2);
      ++n;
    }
  }
  left.um2 /= n;
  left.said_um2 /= n;
  return left;
}

// A filter that knew s and T leaves 0.40 s² of s = 4 um, T = 2 h by the Riccati equation: s² - (s² - P+) (1 - exp(-1)), P+ =
// 0.91. The bank, which must learn them, leaves at most a tenth more, whether its fit is right or three times too small or
// too large. It says too much rather than too little, because a part of the weights returns to the first ones, which know of
// larger errors.
TEST(ProbeFeedback, LearnsHowLargeErrorsAreInThisRun) {
  const ResidualProcess truth{4.0, 7200.0};
  for (const double factor : {1.0 / 3.0, 1.0, 3.0}) {
    const LeftOfDraws left = left_of_draws({factor * truth.deviation_um, truth.time_constant_s}, truth, 1.0);
    EXPECT_LT(left.um2, 1.1 * 0.40 * 16.0) << factor;
    EXPECT_GT(left.said_um2, 0.9 * left.um2) << factor;
    EXPECT_LT(left.said_um2, 4.0 * left.um2) << factor;
  }
}

// Errors of 0.6 um that fade in 20 min, and a probe of 1 um: probings each hour can gain nothing. They cost a fifth at most,
// though the fit says 2 um and 3 h; a filter that believed the fit would be moved by 0.8 of each probing and cost more than
// a half.
TEST(ProbeFeedback, LearnsThatErrorsAreSmallerAndFaster) {
  const LeftOfDraws left = left_of_draws({2.0, 10800.0}, {0.6, 1200.0}, 1.0);
  EXPECT_LT(std::sqrt(left.um2), 1.2 * 0.6);
}

// Of good probings of errors as large as in the fit few are refused, of errors 3 times as large one in 120: a mixture of
// normal laws has more than one law beyond four deviations. The bands are three standard errors of some 17 and 200 refusals,
// and more.
TEST(ProbeFeedback, RefusesAsManyGoodProbingsAsIsSaid) {
  const auto refused_of = [](double times) {
    Random random(7);
    int n_refused = 0, n = 0;
    const double kept = std::exp(-0.5);
    for (int run = 0; run < 4000; ++run) {
      ProbeFeedback feedback({5.0, 7200.0}, {.noise_um = 1.0}, false);
      double um = times * 5.0 * random.normal();
      for (int hour = 0; hour < 12; ++hour) {
        feedback.row(0.0, 0.0, 3600.0);
        (void)feedback.probe_drift_um(um + random.normal());
        n_refused += feedback.state().verdict == PROBE_UNLIKELY;
        ++n;
        um = kept * um + times * 5.0 * std::sqrt(1.0 - kept * kept) * random.normal();
      }
    }
    return static_cast<double>(n_refused) / n;
  };
  EXPECT_NEAR(refused_of(1.0), 1.0 / 3500.0, 1.0 / 4500.0);
  EXPECT_NEAR(refused_of(3.0), 1.0 / 135.0, 1.0 / 600.0);
}

// A calm axis does not say that the next cut is calm: after 50 hours a probing that is 2 deviations of the fit off is taken.
TEST(ProbeFeedback, IsNotMuchStricterAfterACalmTime) {
  ProbeFeedback feedback({3.0, 7200.0}, {.noise_um = 1.0}, true);
  for (int hour = 0; hour < 50; ++hour) {
    feedback.row(0.0, 0.0, 3600.0);
    EXPECT_TRUE(feedback.probe_drift_um(0.0));
  }
  feedback.row(0.0, 0.0, 3600.0);
  EXPECT_TRUE(feedback.probe_drift_um(6.0));
}

// Three chips in a row are taken for a jump, and for large errors. A good probing brings the axis back; a shift later the
// bound of refusal is twice the usual one at most.
TEST(ProbeFeedback, ComesBackAfterThreeChipsInARow) {
  ProbeFeedback feedback({1.5, 7200.0}, {.noise_um = 1.0}, true);
  const std::vector<double> reads = {0.4, 40.0, -35.0, 60.0, 0.3, -0.2, 0.5};
  double usual_um = 0.0;
  for (std::size_t hour = 0; hour < reads.size() + 12; ++hour) {
    feedback.row(0.0, 0.0, 3600.0);
    (void)feedback.probe_drift_um(hour < reads.size() ? reads[hour] : 0.2);
    if (hour == 1) usual_um = feedback.state().bound_um;
    if (hour == 6) {
      EXPECT_NEAR(feedback.estimate_um(), 0.2, 1.5);
    }
  }
  EXPECT_LT(feedback.state().bound_um, 2.0 * usual_um);
}

/// A probing: when its value comes, and drift minus prediction as it reads it.
struct Read {
  double time_s, um;
};

/// Mean and variance of residual and level at a time, given probings, by the joint normal distribution of all numbers: no
/// filter.
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
  return {weights.dot(z), covariance(time_s, time_s) + unknown * has_level(time_s) - weights.dot(with)};
}

/// The same of 16 processes, with the probabilities that each reading leaves them, and which return to those at first in a
/// day.
std::pair<double, double> by_16_covariances(const ResidualProcess& p, const Probe& probe, bool is_known,
                                            const std::vector<Read>& reads, double time_s, double jumped_s = -1.0) {
  std::vector<ResidualProcess> processes;
  std::vector<double> first, w;
  for (const double size : {1.0 / 3.0, 1.0, 3.0, 9.0}) {
    for (const double time : {0.25, 1.0, 4.0, 16.0}) {
      processes.push_back({size * p.deviation_um, time * p.time_constant_s});
      first.push_back(std::exp(-0.5 * std::pow(std::log(size), 2) / (std::numbers::pi * std::numbers::pi / 8.0)));
    }
  }
  const auto normalised = [](std::vector<double> v) {
    const double sum = std::accumulate(v.begin(), v.end(), 0.0);
    for (double& x : v) x /= sum;
    return v;
  };
  first = w = normalised(first);
  double last_s = 0.0;
  const auto wait_until = [&](double t_s) {
    const double same = std::exp(-(t_s - last_s) / 86400.0);
    for (std::size_t k = 0; k < w.size(); ++k) w[k] = same * w[k] + (1.0 - same) * first[k];
    last_s = t_s;
  };
  std::vector<Read> before;
  for (const Read& read : reads) {
    wait_until(read.time_s - probe.lag_s);
    for (std::size_t k = 0; k < w.size(); ++k) {
      const auto [mean_um, um2] = by_covariances(processes[k], probe, is_known, before, read.time_s - probe.lag_s, jumped_s);
      const double all_um2 = um2 + probe.noise_um * probe.noise_um;
      w[k] *= std::exp(-0.5 * std::pow(read.um - mean_um, 2) / all_um2) / std::sqrt(all_um2);
    }
    w = normalised(w);
    before.push_back(read);
  }
  wait_until(time_s);
  double mean_um = 0.0, um2 = 0.0;
  for (std::size_t k = 0; k < w.size(); ++k) {
    const auto [own_um, own_um2] = by_covariances(processes[k], probe, is_known, reads, time_s, jumped_s);
    mean_um += w[k] * own_um;
    um2 += w[k] * (own_um2 + own_um * own_um);
  }
  return {mean_um, um2 - mean_um * mean_um};
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
          const auto [mean_um, um2] = by_16_covariances(p, probe, is_known, reads, time_s + ahead_s);
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

// A drift that is five times faster than the process ever was: the third probing is taken, and what it says of the size of
// errors lets the next ones be taken, too. 20 um an hour: what is left after a probing is 0.5 um or so in most hours, and
// below 65 um.
TEST(ProbeFeedback, FollowsADriftThatIsFasterThanItsProcess) {
  ProbeFeedback feedback({2.0, 36000.0}, {.noise_um = 0.5}, true);
  double most_um = 0.0;
  int n_close = 0;
  for (int hour = 0; hour < 24; ++hour) {
    feedback.row(0.0, 0.0, 3600.0);
    (void)feedback.probe_drift_um(20.0 * hour);
    const double left_um = std::abs(20.0 * hour - feedback.estimate_um());
    most_um = std::max(most_um, left_um);
    n_close += left_um < 1.0;
  }
  EXPECT_GE(n_close, 20);
  EXPECT_LT(most_um, 65.0);
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
    const auto [mean_um, um2] = by_16_covariances(p, probe, false, reads, time_s, 3000.0);
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

/// What became of readings on the corrected axis, an hour apart, while the correction does nothing.
std::vector<int> verdicts(const std::vector<double>& reads_um, double predicted_um_h = 0.0) {
  ProbeFeedback feedback({2.0, 7200.0}, {.noise_um = 1.0}, true);
  std::vector<int> all;
  double hour = 0.0;
  for (const double um : reads_um) {
    feedback.row(predicted_um_h * hour, 0.0, 3600.0);
    hour += 1.0;
    (void)feedback.probe_left_um(um);
    all.push_back(feedback.state().verdict);
  }
  return all;
}

// Steps of 0.1 um, so at 3 um from what is expected an equal reading has a chance of 0.1 * 0.242 / 3 at most, 1 in 124, and
// two of them 1 in 15,400. The prediction moves by 2 um between probings, so the residual of an unmoved reading does, too.
TEST(ProbeFeedback, RefusesAStuckProbeWhileThePredictionMoves) {
  const std::vector<int> moved = verdicts({0.0, 0.1, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 14.0}, 2.0);
  const auto stuck = std::find(moved.begin(), moved.end(), PROBE_STUCK) - moved.begin();
  EXPECT_GE(stuck, 4);  // the second or third equal one
  EXPECT_LE(stuck, 5);
  for (std::size_t k = static_cast<std::size_t>(stuck); k < 9; ++k) EXPECT_EQ(moved[k], PROBE_STUCK) << k;
  EXPECT_NE(moved[9], PROBE_STUCK);  // it reads another number
}

// The product of the chances 0.1 * 0.242 / d of equal readings decides, and falls below 1 in 15,787 after some of them.
TEST(ProbeFeedback, RefusesWhatAGoodProbeWouldNotRepeatOnceIn16000) {
  ProbeFeedback feedback({2.0, 7200.0}, {.noise_um = 1.0}, true);
  double ln_chance = 0.0;
  const std::vector<double> reads = {0.0, 0.1, 5.0, 5.0, 5.0, 5.0, 5.0, 5.0};
  for (std::size_t k = 0; k < reads.size(); ++k) {
    const double predicted_um = 0.7 * static_cast<double>(k);
    feedback.row(predicted_um, 0.0, 3600.0);
    const double off_um = std::min(std::abs(reads[k] - predicted_um - feedback.estimate_um()), 0.7);
    if (k > 2) ln_chance += std::min(0.0, std::log(0.1 * std::exp(-0.5) / std::sqrt(2.0 * std::numbers::pi) / off_um));
    (void)feedback.probe_left_um(reads[k]);
    const bool is_stuck = ln_chance < std::log(std::erfc(4.0 / std::numbers::sqrt2));
    EXPECT_EQ(feedback.state().verdict == PROBE_STUCK, is_stuck) << k;
  }
  EXPECT_EQ(feedback.state().verdict, PROBE_STUCK);
}

// No alarm: a calm axis whose readings are rounded to half of their noise, a drift that stays while the filters expect that
// it fades, and a probe of which no step is known.
TEST(ProbeFeedback, DoesNotCallACalmAxisAStuckProbe) {
  for (const double rounded_um : {0.5, 1.0}) {
    Random random(11);
    int n_stuck = 0;
    ProbeFeedback feedback({0.5, 7200.0}, {.noise_um = 1.0}, true);
    for (int k = 0; k < 5000; ++k) {
      feedback.row(0.0, 0.0, 3600.0);
      (void)feedback.probe_left_um(rounded_um * std::round(0.4 * random.normal() / rounded_um));  // better than is said
      n_stuck += feedback.state().verdict == PROBE_STUCK;
    }
    EXPECT_LE(n_stuck, 2) << rounded_um;
  }
  for (const int verdict : verdicts({0.0, 0.1, 3.0, 3.0, 3.0, 3.0, 3.0, 3.0, 3.0})) EXPECT_EQ(verdict, PROBE_TAKEN);
  for (const int verdict : verdicts({0.0, 0.0, 0.0, 0.0}, 2.0)) EXPECT_NE(verdict, PROBE_STUCK);
}

TEST(ProbeFeedback, TakesNoRoundingOfReadingsForAStepOfTheProbe) {
  for (const int verdict : verdicts({0.1 + 0.2, 0.3, 0.3, 0.3}, 0.05)) EXPECT_EQ(verdict, PROBE_TAKEN);
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
