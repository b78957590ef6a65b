// Weights among predictors that are probed together: fixed share against the sum over all sequences of members and its
// bound, and the mixture of their filters against its formulas.

#include "compensation/control/probe_members.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "base/random.hpp"
#include "compensation/predictors/residual_process.hpp"

namespace driftwright::compensation::probe_members_test {
namespace {

using Losses = std::vector<std::vector<double>>;  // [step][member]

Losses drawn(std::size_t n_steps, std::size_t n_members, std::uint64_t seed) {
  Random random(seed, 2);
  Losses losses(n_steps, std::vector<double>(n_members));
  for (auto& step : losses) {
    for (double& l : step) l = 3.0 * random.uniform();
  }
  return losses;
}

/// A member for each step, counted through.
std::vector<std::size_t> sequence_of(std::size_t number, std::size_t n_steps, std::size_t n_members) {
  std::vector<std::size_t> sequence;
  for (std::size_t t = 0; t < n_steps; ++t, number /= n_members) sequence.push_back(number % n_members);
  return sequence;
}

std::size_t power(std::size_t base, std::size_t exponent) {
  return exponent == 0 ? 1 : base * power(base, exponent - 1);
}

/// Weights of members without filters, by the functions of the C file.
struct Weights {
  explicit Weights(std::size_t n) : members(n) {
    for (probe_member& m : members) m.weight = 1.0 / static_cast<double>(n);
  }
  void learn(const std::vector<double>& losses, double share) {
    for (std::size_t k = 0; k < members.size(); ++k) members[k].loss = losses[k];
    loss += probe_weights_learn(members.data(), static_cast<int>(members.size()));
    probe_weights_share(members.data(), static_cast<int>(members.size()), share);
  }
  std::vector<probe_member> members;
  double loss = 0.0;
};

/// ln n + k ln((n - 1) / a) - (T - 1 - k) ln(1 - a), as probe_members.h has it.
double regret(std::size_t n_members, std::size_t n_losses, std::size_t n_changes, double share) {
  const auto n = static_cast<double>(n_members), k = static_cast<double>(n_changes);
  return std::log(n) + k * std::log((n - 1.0) / share) - (static_cast<double>(n_losses) - 1.0 - k) * std::log(1.0 - share);
}

// The best member is a Markov chain: the weights are its probabilities after all losses, and exp(-loss) is the sum over all
// sequences of their probability times exp(-losses).
TEST(ProbeMembers, WeightsAreTheProbabilitiesOfAChainOfMembers) {
  constexpr std::size_t kSteps = 6, kMembers = 3;
  const double share = 0.15;
  const Losses losses = drawn(kSteps, kMembers, 5);
  Weights weights(kMembers);
  for (const auto& step : losses) weights.learn(step, share);
  double all = 0.0;
  std::vector<double> next(kMembers, 0.0);  // of the member after the last loss
  for (std::size_t s = 0; s < power(kMembers, kSteps); ++s) {
    const std::vector<std::size_t> sequence = sequence_of(s, kSteps, kMembers);
    double probability = 1.0 / kMembers;
    for (std::size_t t = 0; t < kSteps; ++t) {
      if (t > 0) probability *= sequence[t] == sequence[t - 1] ? 1.0 - share : share / (kMembers - 1.0);
      probability *= std::exp(-losses[t][sequence[t]]);
    }
    all += probability;
    for (std::size_t i = 0; i < kMembers; ++i)
      next[i] += probability * (i == sequence.back() ? 1.0 - share : share / (kMembers - 1.0));
  }
  EXPECT_NEAR(weights.loss, -std::log(all), 1e-12);
  for (std::size_t i = 0; i < kMembers; ++i) EXPECT_NEAR(weights.members[i].weight, next[i] / all, 1e-12);
}

// No sequence of members is better than the weights by more than the bound.
TEST(ProbeMembers, WeightsKeepTheBoundOfHerbsterAndWarmuth) {
  constexpr std::size_t kSteps = 7, kMembers = 3;
  double nearest = 1e9;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const double share = 0.05 + 0.02 * static_cast<double>(seed);
    const Losses losses = drawn(kSteps, kMembers, seed);
    Weights weights(kMembers);
    for (const auto& step : losses) weights.learn(step, share);
    for (std::size_t s = 0; s < power(kMembers, kSteps); ++s) {
      const std::vector<std::size_t> sequence = sequence_of(s, kSteps, kMembers);
      double along = 0.0;
      std::size_t n_changes = 0;
      for (std::size_t t = 0; t < kSteps; ++t) {
        along += losses[t][sequence[t]];
        n_changes += t > 0 && sequence[t] != sequence[t - 1];
      }
      const double room = along + regret(kMembers, kSteps, n_changes, share) - weights.loss;
      ASSERT_GE(room, -1e-12);
      nearest = std::min(nearest, room);
    }
  }
  EXPECT_LT(nearest, 3.0);  // it is no empty bound
}

// A member that was the worst for long leads again a few steps after it has become the best.
TEST(ProbeMembers, AMemberComesBack) {
  Weights weights(2);
  for (int t = 0; t < 200; ++t) weights.learn({0.0, 2.0}, 0.1);
  EXPECT_GT(weights.members[0].weight, 0.85);
  for (int t = 0; t < 3; ++t) weights.learn({2.0, 0.0}, 0.1);
  EXPECT_GT(weights.members[1].weight, 0.8);
  Weights alone(1);
  alone.learn({700.0}, 0.1);
  EXPECT_EQ(alone.members[0].weight, 1.0);
  EXPECT_EQ(alone.loss, 700.0);
}

TEST(ProbeMembers, LossesMayBeBeyondTheRangeOfExponentials) {
  Weights weights(3);
  weights.learn({5000.0, 5001.0, 9000.0}, 0.0);
  EXPECT_NEAR(weights.members[0].weight, 1.0 / (1.0 + std::exp(-1.0)), 1e-12);
  EXPECT_NEAR(weights.loss, 5000.0 + std::log(3.0) - std::log(1.0 + std::exp(-1.0)), 1e-9);
}

/// Density of a first probing by a filter's 16 processes, times sqrt(2 pi), and its negative logarithm: four deviations
/// count at most.
double first_loss(double off_um, double deviation_um, double noise_um) {
  double density = 0.0, sum = 0.0, um2 = 0.0;
  for (const double size : {1.0 / 3.0, 1.0, 3.0, 9.0}) {
    const double w = std::exp(-4.0 * std::pow(std::log(size) / std::numbers::pi, 2));
    const double own_um2 = std::pow(size * deviation_um, 2) + noise_um * noise_um;
    density += w * std::exp(-0.5 * off_um * off_um / own_um2) / std::sqrt(own_um2);
    um2 += w * own_um2;
    sum += w;
  }
  return std::min(-std::log(density / sum), 8.0 + 0.5 * std::log(um2 / sum));
}

TEST(ProbeMembers, AProbingCostsByItsDensity) {
  for (const double read_um : {2.0, -15.0, 500.0}) {
    ProbeFeedback feedback({3.0, 3600.0}, {.noise_um = 4.0}, false);
    feedback.row(0.0, 0.0, 0.0);
    (void)feedback.probe_drift_um(read_um);
    EXPECT_NEAR(feedback.state().loss, first_loss(read_um, 3.0, 4.0), 1e-12);
  }
}

// The share over a time is that of a chain which leaves its member once in a shift: rate 1/S at first, equal parts in the
// end, and the same in one step as in many.
TEST(ProbeMembers, TheShareIsThatOfAChainInTime) {
  EXPECT_NEAR(probe_share(4, 1.0) * PROBE_SHIFT_S, 1.0, 1e-4);
  EXPECT_NEAR(probe_share(2, 1e9), 0.5, 1e-12);
  EXPECT_NEAR(probe_share(5, 1e9), 0.8, 1e-12);
  EXPECT_EQ(probe_share(1, 3600.0), 0.0);
  Weights once(3), often(3);
  for (Weights* w : {&once, &often}) {
    w->members[0].weight = 0.7;
    w->members[1].weight = 0.3;
    w->members[2].weight = 0.0;
  }
  probe_weights_share(once.members.data(), 3, probe_share(3, 7200.0));
  for (int k = 0; k < 120; ++k) probe_weights_share(often.members.data(), 3, probe_share(3, 60.0));
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(often.members[k].weight, once.members[k].weight, 1e-12);
  EXPECT_GT(once.members[2].weight, 0.05);
}

/// A blend (0) and two members, whose drift does not count from the start.
ProbeFeedback of_three() {
  return ProbeFeedback(
      std::vector<probe_process>{{3.0, 7200.0, 0.5, 0.0, 0}, {4.0, 3600.0, 0.5, 0.0, 0}, {2.0, 14400.0, 0.5, 0.0, 0}});
}

/// Deviation before a probing over that of the fit: factors 1/3, 1, 3, 9 with a normal logarithm of deviation pi / sqrt(8).
double first_factor() {
  double um2 = 0.0, sum = 0.0;
  for (const double size : {1.0 / 3.0, 1.0, 3.0, 9.0}) {
    const double w = std::exp(-4.0 * std::pow(std::log(size) / std::numbers::pi, 2));
    um2 += w * size * size;
    sum += w;
  }
  return std::sqrt(um2 / sum);
}

// Before a probing: the mean of the predictions, and the deviation of a mixture of three with equal weights.
TEST(ProbeMembers, BeforeAProbingAreTheMeanAndItsDeviation) {
  ProbeFeedback feedback = of_three();
  feedback.row(std::vector<double>{10.0, 16.0, 4.0}, 0.0, 0.0);
  feedback.row(std::vector<double>{10.0, 16.0, 4.0}, 0.0, 600.0);
  EXPECT_NEAR(feedback.estimate_um(), 0.0, 1e-12);
  EXPECT_NEAR(feedback.deviation_um(), std::sqrt((std::pow(first_factor(), 2) * (9.0 + 16.0 + 4.0) + 2.0 * 36.0) / 3.0),
              1e-9);
  feedback.row(std::vector<double>{11.0, NAN, 5.0}, 0.0, 60.0);  // a prediction that is missing stays
  EXPECT_NEAR(feedback.estimate_um(), (16.0 + 5.0 + 11.0) / 3.0 - 11.0, 1e-12);
  EXPECT_THROW(feedback.row(2.0, 0.0, 60.0), std::logic_error);
}

// One probing of 15 um: each member's filter takes its own residual, and its weight is its density of the reading. Later the
// weights return to equal parts.
TEST(ProbeMembers, AProbingMovesWeightsAndResiduals) {
  ProbeFeedback feedback = of_three();
  const std::vector<double> predicted = {10.0, 16.0, 4.0}, s = {3.0, 4.0, 2.0}, fades_s = {7200.0, 3600.0, 14400.0};
  feedback.row(predicted, 0.0, 0.0);
  EXPECT_TRUE(feedback.probe_drift_um(15.0));
  std::vector<double> weight(3), at(3);
  for (std::size_t k = 0; k < 3; ++k) {
    weight[k] = std::exp(-first_loss(15.0 - predicted[k], s[k], 0.5));
    ProbeFeedback alone({s[k], fades_s[k]}, {.noise_um = 0.5}, false);
    alone.row(predicted[k], 0.0, 0.0);
    EXPECT_TRUE(alone.probe_drift_um(15.0));
    at[k] = predicted[k] + alone.estimate_um();
  }
  const double sum = weight[0] + weight[1] + weight[2];
  double expected = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(feedback.members()[k].weight, weight[k] / sum, 1e-9) << k;
    expected += weight[k] / sum * at[k];
  }
  EXPECT_NEAR(predicted[0] + feedback.estimate_um(), expected, 1e-9);
  EXPECT_GT(feedback.members()[1].weight, 0.6);   // 1 um off
  EXPECT_LT(feedback.members()[2].weight, 0.12);  // 11 um off
  EXPECT_EQ(feedback.n_refused(), 0);             // by the one that led
  for (int k = 0; k < 96 * 60; ++k) feedback.row(predicted, 0.0, 60.0);
  for (const probe_member& m : feedback.members()) EXPECT_NEAR(m.weight, 1.0 / 3.0, 1e-3);
  EXPECT_NEAR(feedback.estimate_um(), 0.0, 0.5);  // time constants up to 64 h are likely, too
}

// With a member alone all numbers are those of its filter.
TEST(ProbeMembers, OneAloneIsItsFilter) {
  const probe_process process{3.0, 7200.0, 0.5, 90.0, 1};
  probe_state filter{};
  ProbeFeedback alone(std::vector<probe_process>{process});
  for (int k = 0; k < 300; ++k) {
    probe_row(&process, &filter, 0.1 * k, 0.05 * k, 60.0);
    alone.row(0.1 * k, 0.05 * k, 60.0);
    if (k % 40 == 39) {
      const double left_um = k == 119 ? 80.0 : 0.05 * k + 2.0;
      const int verdict = probe_left(&process, &filter, left_um);
      EXPECT_EQ(alone.probe_left_um(left_um), verdict == PROBE_TAKEN || verdict == PROBE_JUMP);
      EXPECT_EQ(alone.state().verdict, verdict);
    }
    ASSERT_EQ(alone.estimate_um(), probe_expected_um(&process, &filter, 0.0)) << k;
    ASSERT_EQ(alone.deviation_um(600.0), probe_deviation_um(&process, &filter, 600.0)) << k;
    ASSERT_EQ(alone.n_refused(), filter.n_refused) << k;
  }
  EXPECT_EQ(alone.n_refused(), 1);
}

TEST(ProbeMembers, GoOnFromTheirMemory) {
  ProbeFeedback whole = of_three(), second = of_three();
  const auto step = [](ProbeFeedback& f, int k) {
    f.row(std::vector<double>{0.1 * k, 0.2 * k, 3.0}, 0.0, 60.0);
    if (k % 7 == 6) (void)f.probe_drift_um(k == 20 ? 90.0 : 0.15 * k + 1.0);
  };
  for (int k = 0; k < 50; ++k) step(whole, k);
  second.recall(whole.memory());
  for (int k = 50; k < 100; ++k) {
    step(whole, k);
    step(second, k);
    ASSERT_EQ(second.memory(), whole.memory()) << k;
    ASSERT_EQ(second.estimate_um(), whole.estimate_um()) << k;
  }
  EXPECT_THROW(second.recall(ProbeFeedback({2.0, 7200.0}, {}, true).memory()), std::logic_error);
}

// The blend's own correction and trust: a member differs by what trust leaves of its distance.
TEST(ProbeMembers, AMemberOfABlendIsGuardedAsTheBlendIs) {
  EXPECT_EQ(probe_member_um(7.0, 1.0, 8.0, 10.0), 9.0);
  EXPECT_EQ(probe_member_um(7.0, 0.5, 8.0, 10.0), 8.0);
  EXPECT_EQ(probe_member_um(7.0, 0.0, 8.0, 10.0), 7.0);
}

}  // namespace
}  // namespace driftwright::compensation::probe_members_test
