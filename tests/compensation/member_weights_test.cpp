// Fixed share against the sum over all sequences of members, and its bound.

#include "compensation/predictors/member_weights.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "base/random.hpp"
#include "compensation/predictors/residual_process.hpp"

namespace driftwright::compensation::member_weights_test {
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

// The best member is a Markov chain: the weights are its probabilities after all losses, and exp(-loss()) is the sum over
// all sequences of their probability times exp(-losses).
TEST(MemberWeights, AreTheProbabilitiesOfAChainOfMembers) {
  constexpr std::size_t kSteps = 6, kMembers = 3;
  const double share = 0.15;
  const Losses losses = drawn(kSteps, kMembers, 5);
  MemberWeights weights(kMembers);
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
  EXPECT_NEAR(weights.loss(), -std::log(all), 1e-12);
  for (std::size_t i = 0; i < kMembers; ++i) EXPECT_NEAR(weights.weights()[i], next[i] / all, 1e-12);
}

// No sequence of members is better than the weights by more than the bound.
TEST(MemberWeights, KeepTheBoundOfHerbsterAndWarmuth) {
  constexpr std::size_t kSteps = 7, kMembers = 3;
  double nearest = 1e9;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const double share = 0.05 + 0.02 * static_cast<double>(seed);
    const Losses losses = drawn(kSteps, kMembers, seed);
    MemberWeights weights(kMembers);
    for (const auto& step : losses) weights.learn(step, share);
    for (std::size_t s = 0; s < power(kMembers, kSteps); ++s) {
      const std::vector<std::size_t> sequence = sequence_of(s, kSteps, kMembers);
      double along = 0.0;
      std::size_t n_changes = 0;
      for (std::size_t t = 0; t < kSteps; ++t) {
        along += losses[t][sequence[t]];
        n_changes += t > 0 && sequence[t] != sequence[t - 1];
      }
      const double room = along + fixed_share_regret(kMembers, kSteps, n_changes, share) - weights.loss();
      ASSERT_GE(room, -1e-12);
      nearest = std::min(nearest, room);
    }
  }
  EXPECT_LT(nearest, 3.0);  // it is no empty bound
}

// A member that was the worst for long leads again a few steps after it has become the best.
TEST(MemberWeights, ComeBack) {
  MemberWeights weights(2);
  for (int t = 0; t < 200; ++t) weights.learn(std::vector<double>{0.0, 2.0}, 0.1);
  EXPECT_GT(weights.weights()[0], 0.85);
  for (int t = 0; t < 3; ++t) weights.learn(std::vector<double>{2.0, 0.0}, 0.1);
  EXPECT_GT(weights.weights()[1], 0.8);
  EXPECT_THROW(weights.learn(std::vector<double>{1.0}, 0.1), std::logic_error);
  MemberWeights alone(1);
  alone.learn(std::vector<double>{700.0}, 0.1);
  EXPECT_EQ(alone.weights()[0], 1.0);
}

TEST(MemberWeights, BearLossesBeyondTheRangeOfExponentials) {
  MemberWeights weights(3);
  weights.learn(std::vector<double>{5000.0, 5001.0, 9000.0}, 0.0);
  EXPECT_NEAR(weights.weights()[0], 1.0 / (1.0 + std::exp(-1.0)), 1e-12);
  EXPECT_NEAR(weights.loss(), 5000.0 + std::log(3.0) - std::log(1.0 + std::exp(-1.0)), 1e-9);
}

// Of a first probing at deviation 3 with noise 4 the density has the deviation 5; a chip counts as four deviations.
TEST(MemberWeights, AProbingCostsByItsDensity) {
  for (const double read_um : {2.0, -15.0, 500.0}) {
    ProbeFeedback feedback({3.0, 3600.0}, {.noise_um = 4.0}, false);
    feedback.row(0.0, 0.0, 0.0);
    (void)feedback.probe_drift_um(read_um);
    const double u2 = std::min(std::pow(read_um / 5.0, 2), 16.0);
    EXPECT_NEAR(probing_loss(feedback.state()), 0.5 * u2 + std::log(5.0), 1e-12);
  }
  EXPECT_NEAR(share_after(8.0 * 3600.0), 1.0 - std::exp(-1.0), 1e-12);
}

}  // namespace
}  // namespace driftwright::compensation::member_weights_test
