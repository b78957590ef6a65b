// Runs of a probed axis: one predictor against the filter alone, several with moving weights, probes that fail.

#include "compensation/judging/probed_run.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"

namespace driftwright::compensation::probed_run_test {
namespace {

struct Machine {
  std::vector<double> time_s;
  std::vector<double> left_um;
};

/// What a correction leaves: a draw of the process, each minute.
Machine drawn(const ResidualProcess& p, std::size_t n_rows, std::uint64_t seed) {
  Random random(seed, 3);
  Machine m;
  const double kept = std::exp(-60.0 / p.time_constant_s);
  double um = 0.0;
  for (std::size_t i = 0; i < n_rows; ++i) {
    m.time_s.push_back(60.0 * static_cast<double>(i));
    m.left_um.push_back(um);
    um = kept * um + p.deviation_um * std::sqrt(1.0 - kept * kept) * random.normal();
  }
  return m;
}

/// The drift counts from the start.
probe_process with_process(const ResidualProcess& p, double noise_um) {
  return probe_process_of(p, {.noise_um = noise_um}, true);
}

// One member is the filter of `follow` between rows; before the first probing nothing changes.
TEST(ProbedRun, OfOnePredictorIsItsFilter) {
  const ResidualProcess p{3.0, 7200.0};
  const Machine m = drawn(p, 600, 4);
  const probe_process d = with_process(p, 1e-6);
  const std::vector<ProbedMember> alone = {{d, m.left_um}};
  const ProbedRun run = probed_run(alone, m.time_s, {.every_s = 3600.0, .noise_um = 0.0});
  EXPECT_EQ(run.n_probings, 9);
  EXPECT_EQ(run.n_refused, 0);
  ProbeFeedback feedback(std::vector<probe_process>{d});
  double square = 0.0;
  for (std::size_t i = 0; i < 600; ++i) {
    feedback.row(0.0, 0.0, i > 0 ? 60.0 : 0.0);
    square += std::pow(m.left_um[i] - feedback.estimate_um(), 2);
    if (i > 0 && i % 60 == 0) {
      EXPECT_TRUE(feedback.probe_drift_um(m.left_um[i]));  // it counts from the row after it
    }
  }
  EXPECT_NEAR(run.left.rmse, std::sqrt(square / 600.0), 1e-9);
  EXPECT_LT(run.left.rmse, 0.7 * 3.0);
}

// Two members: one is right in the first half and then 30 µm off, the other one the reverse. With weights less is left than
// by either with its own probings; two equal members leave what one leaves.
TEST(ProbedRun, WeightsFollowTheMemberThatIsRight) {
  const ResidualProcess p{2.0, 7200.0};
  Machine good = drawn(p, 2880, 6), bad = good;
  Random random(8, 1);
  const auto is_first_half = [](std::size_t i) { return i < 1440; };
  for (std::size_t i = 0; i < 2880; ++i) {
    const double off_um = 30.0 * std::sin(0.05 * static_cast<double>(i));  // too fast for probings each half hour
    (is_first_half(i) ? bad : good).left_um[i] += off_um;
  }
  const probe_process d = with_process(p, 0.5);
  const std::vector<ProbedMember> both = {{d, good.left_um}, {d, bad.left_um}};
  const RunProbing how{.every_s = 1800.0, .noise_um = 0.5, .seed = 3};
  const ProbedRun weighted = probed_run(both, good.time_s, how);
  for (const ProbedMember& m : both) {
    const std::vector<ProbedMember> alone = {m};
    EXPECT_LT(weighted.left.rmse, 0.6 * probed_run(alone, good.time_s, how).left.rmse);
  }
  const std::vector<ProbedMember> twins = {{d, good.left_um}, {d, good.left_um}};
  const std::vector<ProbedMember> one = {{d, good.left_um}};
  EXPECT_NEAR(probed_run(twins, good.time_s, how).left.rmse, probed_run(one, good.time_s, how).left.rmse, 1e-9);
}

// A probe that reads a constant too much from 5 h on: beyond the bound of refusal it is noticed at the first probing, and
// the second one is taken for a jump, so the axis goes wrong by the constant. Far below the bound no one notices it.
TEST(ProbedRun, ABiasedProbeIsNoticedBeyondTheBoundOfRefusal) {
  const ResidualProcess p{1.0, 7200.0};
  const Machine m = drawn(p, 900, 5);
  const probe_process d = with_process(p, 0.3);
  const std::vector<ProbedMember> alone = {{d, m.left_um}};
  RunProbing how{.every_s = 3600.0, .noise_um = 0.3, .seed = 2, .fault = ProbeFault::kBiased, .fails_at_s = 18000.0};
  how.error_um = 12.0;
  const ProbedRun large = probed_run(alone, m.time_s, how);
  EXPECT_EQ(large.noticed_at, 1);
  EXPECT_EQ(large.n_refused, 1);
  EXPECT_NEAR(large.left.peak_abs, 12.0, 3.0);
  how.error_um = 0.5;
  const ProbedRun small = probed_run(alone, m.time_s, how);
  EXPECT_FALSE(small.noticed_at);
  EXPECT_LT(small.left.rmse, 1.0);
  how.fault = ProbeFault::kNone;
  EXPECT_FALSE(probed_run(alone, m.time_s, how).noticed_at);
}

// An error that grows by 2 µm an hour, and from 10 h on a probe that goes on reading what it read on the corrected axis:
// some 2 µm. Each reading moves the axis by as much, and none is beyond four deviations. Good readings differ by 0.05 µm or
// more, so one that is equal 2 µm from what is expected has a chance of 1 in 165 at most; two of them have 1 in 27,000, and
// the second one is refused. Without this, five further ones would move the axis by 10 µm more.
TEST(ProbedRun, AStuckProbeIsNoticedAfterTwoReadings) {
  Machine m = drawn({16.0, 3.6e6}, 1000, 5);
  for (std::size_t i = 0; i < m.left_um.size(); ++i) m.left_um[i] = 2.0 * m.time_s[i] / 3600.0;
  const probe_process d = with_process({16.0, 3.6e6}, 0.1);
  const std::vector<ProbedMember> alone = {{d, m.left_um}};
  RunProbing how{.every_s = 3600.0, .noise_um = 0.1, .fault = ProbeFault::kStuck, .fails_at_s = 36000.0};
  const ProbedRun run = probed_run(alone, m.time_s, how);
  EXPECT_EQ(run.n_probings, 16);
  ASSERT_TRUE(run.noticed_at);
  EXPECT_LE(*run.noticed_at, 3);
  EXPECT_EQ(run.n_refused, 16 - 9 - *run.noticed_at + 1);  // and all that follow
  how.fault = ProbeFault::kNone;
  EXPECT_EQ(probed_run(alone, m.time_s, how).n_refused, 0);
}

}  // namespace
}  // namespace driftwright::compensation::probed_run_test
