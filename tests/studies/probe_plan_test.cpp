// Plans of probings against closed forms, against all other plans, and against the filter of `follow` on drawn drifts.

#include "studies/probe_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

#include "base/random.hpp"

namespace driftwright::studies::probe_plan_test {
namespace {

/// Work without a break, places at these times.
ProbeJob job_with(double until_s, const std::vector<double>& places_s) {
  ProbeJob job{.name = "job", .work = {{0.0, until_s}}};
  for (double t_s : places_s) job.places.push_back({.time_s = t_s, .where = "tool change"});
  return job;
}

std::vector<std::size_t> places_of(const ProbeSequence& sequence) {
  std::vector<std::size_t> places;
  for (const PlannedProbing& p : sequence.probings) places.push_back(p.place);
  return places;
}

/// Calls for each plan with n probings.
void for_each_plan(std::size_t n_places, std::size_t n, std::vector<std::size_t>& plan,
                   const std::function<void(const std::vector<std::size_t>&)>& call) {
  if (plan.size() == n) return call(plan);
  for (std::size_t k = plan.empty() ? 0 : plan.back(); k < n_places; ++k) {
    plan.push_back(k);
    for_each_plan(n_places, n, plan, call);
    plan.pop_back();
  }
}

// A probing without noise makes the variance 0, so the half width after h is factor s sqrt(1 - exp(-2 h / T)). It reaches
// the tolerance after h = -T/2 ln(1 - (tolerance / (factor s))²): 1726 s here. Of places each 600 s the latest within is the
// second one.
TEST(ProbePlan, AnExactProbeIsNeededAgainAfterAClosedTime) {
  ProbedAxis axis{.process = {5.0, 7200.0}, .probe = {.noise_um = 1e-9}, .is_known_at_start = true, .factor = 2.0};
  const double tolerance_um = 6.171;
  const double reach_s = -3600.0 * std::log(1.0 - std::pow(tolerance_um / 10.0, 2));
  ASSERT_NEAR(reach_s, 1726.0, 1.0);
  std::vector<double> places_s;
  for (int k = 1; k < 12; ++k) places_s.push_back(600.0 * k);
  const ProbeJob job = job_with(7200.0, places_s);
  const auto plan = fewest_probings(job, axis, tolerance_um);
  ASSERT_TRUE(plan);
  EXPECT_THAT(places_of(*plan), testing::ElementsAre(1, 3, 5, 7, 9));  // at 1200, 2400 ... 6000 s
  EXPECT_NEAR(plan->worst_um, 10.0 * std::sqrt(1.0 - std::exp(-1200.0 / 3600.0)), 1e-6);
  EXPECT_NEAR(plan->probings[0].after_um, 0.0, 1e-6);
  EXPECT_DOUBLE_EQ(plan->lost_s, 5 * 120.0);
  // the mean variance of a stretch of h is s² (1 - T / (2 h) (1 - exp(-2 h / T)))
  EXPECT_NEAR(plan->rms_um, 5.0 * std::sqrt(1.0 - 3.0 * (1.0 - std::exp(-1.0 / 3.0))), 1e-6);
}

// Two touches of a process with T = 2 h, noise 1 um, s = 3 um (widened to 4): 0.9 h and 0.1 h of a probing apart they differ
// by sqrt(2 + 32 (1 - exp(-0.5))). The time before the first probing does not count, the one after the last does.
TEST(ProbePlan, BoundsATouchByTheLongestTimeWithoutOne) {
  ProbePlan plan{
      .job = job_with(10800.0, {4500.0, 7560.0}),
      .axis = {.process = {3.0, 7200.0}, .probe = {.noise_um = 1.0}, .factor = 1.96 * 4.0 / 3.0, .probing_s = 360.0},
      .best = ProbeSequence{.probings = {{.place = 0}, {.place = 1}}}};
  const TouchBounds bounds = touch_bounds(plan);
  EXPECT_NEAR(bounds.first_um, 4.0 * std::sqrt(17.0), 1e-9);
  EXPECT_NEAR(bounds.step_um, 4.0 * std::sqrt(2.0 + 32.0 * (1.0 - std::exp(-0.5))), 1e-9);
  plan.best->probings = {};  // from the start to the end
  EXPECT_NEAR(touch_bounds(plan).step_um, 4.0 * std::sqrt(2.0 + 32.0 * (1.0 - std::exp(-11160.0 / 7200.0))), 1e-9);
}

// Probings at equal times: the variance before each is that of the stationary Riccati equation of a scalar,
// P = a² P r² / (P + r²) + (1 - a²) s².
TEST(ProbePlan, ManyEqualProbingsLeaveWhatTheRiccatiEquationSays) {
  const ProbedAxis axis{.process = {4.0, 7200.0}, .probe = {.noise_um = 1.0}, .factor = 1.96};
  std::vector<double> places_s;
  for (int k = 0; k < 60; ++k) places_s.push_back(3600.0 * k);
  const ProbeSequence equal = equal_probings(job_with(60 * 3600.0, places_s), axis, 60);
  const double a2 = std::exp(-1.0), q = (1.0 - a2) * 16.0, b = 1.0 - a2 - q;
  EXPECT_NEAR(equal.probings.back().before_um, 1.96 * std::sqrt(0.5 * (-b + std::sqrt(b * b + 4.0 * q))), 1e-9);
}

// Among all plans, also those with several probings of one place, none has fewer probings, and with as many none has a
// smaller largest half width. Some jobs begin with a rest, and some rest at the third place.
TEST(ProbePlan, NoOtherPlanHasFewerProbingsOrLeavesLess) {
  Random random(7, 1);
  int n_judged = 0, n_doubled = 0, n_rested = 0;
  for (int draw = 0; draw < 120; ++draw) {
    std::vector<double> places_s;
    double t_s = 0.0;
    for (int k = 0; k < 6; ++k) places_s.push_back(t_s += 200.0 + 2500.0 * random.uniform());
    ProbeJob job = job_with(t_s + 1500.0, places_s);
    const bool rests_first = draw % 4 >= 2;
    if (rests_first) job.work[0].from_s = t_s * random.uniform();
    if (draw % 5 == 0 && job.work[0].from_s < places_s[1])
      job.work = {{job.work[0].from_s, 0.5 * (places_s[1] + places_s[2])}, {places_s[2], t_s + 1500.0}};
    const ProbedAxis axis{.process = {1.0 + 4.0 * random.uniform(), 2000.0 + 9000.0 * random.uniform()},
                          .probe = {.noise_um = 0.1 + 3.0 * random.uniform(), .lag_s = draw % 3 == 0 ? 60.0 : 0.0},
                          .is_known_at_start = draw % 2 == 0};
    const double tolerance_um = (0.5 + 0.5 * random.uniform()) * 1.96 * axis.process.deviation_um;
    const auto plan = fewest_probings(job, axis, tolerance_um);
    const std::size_t n = plan ? plan->probings.size() : 6;
    if (n > 6) continue;  // too many plans
    if (plan) {
      EXPECT_LE(plan->worst_um, tolerance_um);
      for (std::size_t k = 1; k < n; ++k) n_doubled += plan->probings[k].place == plan->probings[k - 1].place;
    }
    double least_um = 1e9;
    for (std::size_t m = 0; m <= n; ++m) {
      std::vector<std::size_t> tried;
      for_each_plan(6, m, tried, [&](const std::vector<std::size_t>& places) {
        const double worst_um = judged_probings(job, axis, places).worst_um;
        least_um = std::min(least_um, worst_um);
        if (m < n || !plan) {
          EXPECT_GT(worst_um, tolerance_um) << draw << ": " << m << " are enough";
        }
      });
    }
    EXPECT_NEAR(best_probings(job, axis, n).worst_um, least_um, 2e-6 * least_um) << draw;
    if (plan && n > 0) ++n_judged;
    if (plan && n > 0 && rests_first) ++n_rested;
  }
  EXPECT_GT(n_judged, 20);
  EXPECT_GT(n_rested, 10);
  EXPECT_GT(n_doubled, 0);
}

// On drifts drawn from the process, probed where the plan says, the filter of `follow` leaves an error within the tolerance
// in
// 95 % at the worst moment; and as much on average as the plan says. 4000 draws: three standard errors are 1 %.
TEST(ProbePlan, TheFilterOfFollowKeepsTheToleranceAsOftenAsPlanned) {
  ProbedAxis axis{.process = {3.0, 5400.0}, .probe = {.noise_um = 0.8}, .is_known_at_start = true};
  const ProbeJob job = job_with(9000.0, {1500.0, 2100.0, 4200.0, 5700.0, 7800.0});
  const auto plan = fewest_probings(job, axis, 4.9);
  ASSERT_TRUE(plan);
  ASSERT_GE(plan->probings.size(), 2U);
  int n_within = 0;
  double square = 0.0, n_rows = 0.0;
  constexpr int kDraws = 4000;
  const double kept = std::exp(-60.0 / 5400.0);
  for (int draw = 0; draw < kDraws; ++draw) {
    Random random(static_cast<std::uint64_t>(draw) + 1, 9);
    compensation::ProbeFeedback feedback(axis.process, axis.probe, true);
    double um = 0.0;
    std::size_t next = 0;
    for (int row = 0; row <= 150; ++row) {
      feedback.row(0.0, 0.0, 60.0);
      const double left_um = um - feedback.estimate_um();
      if (next < plan->probings.size() && job.places[plan->probings[next].place].time_s <= 60.0 * row) {
        (void)feedback.probe_drift_um(um + 0.8 * random.normal());
        ++next;
      }
      if (60.0 * row == plan->worst_s) n_within += std::abs(left_um) <= plan->worst_um;
      square += left_um * left_um;
      ++n_rows;
      um = kept * um + 3.0 * std::sqrt(1.0 - kept * kept) * random.normal();
    }
  }
  EXPECT_NEAR(n_within / static_cast<double>(kDraws), 0.95, 0.0105);
  EXPECT_NEAR(std::sqrt(square / n_rows), plan->rms_um, 0.03 * plan->rms_um);
}

// A rest that is as long as a probing costs no time, and the tolerance need not be kept in it.
TEST(ProbePlan, ARestCostsNothingAndKeepsNothing) {
  const ProbedAxis axis{.process = {5.0, 7200.0}, .probe = {.noise_um = 0.1}, .is_known_at_start = true, .probing_s = 300.0};
  ProbeJob job{.name = "job", .work = {{0.0, 1000.0}, {1600.0, 2600.0}, {2700.0, 3700.0}}};
  job.places = {{.time_s = 1600.0, .where = "after a rest"}, {.time_s = 2700.0, .where = "after a rest"}};
  const std::vector<std::size_t> both = {0, 1};
  const ProbeSequence all = judged_probings(job, axis, both);
  EXPECT_DOUBLE_EQ(all.probings[0].lost_s, 0.0);
  EXPECT_DOUBLE_EQ(all.probings[1].lost_s, 200.0);
  EXPECT_NEAR(all.probings[0].before_um, 1.96 * 5.0 * std::sqrt(1.0 - std::exp(-1000.0 / 3600.0)), 1e-9);
  EXPECT_TRUE(fewest_probings(job, axis, all.worst_um * 1.0001));
}

// Before the first work nothing has to be kept, and a probing in the rest with which the job begins costs no time.
TEST(ProbePlan, ARestBeforeAllWorkNeedsOneProbingAtItsEnd) {
  const ProbedAxis axis{.process = {5.0, 7200.0}, .probe = {.noise_um = 0.1}, .probing_s = 300.0};
  ProbeJob job{.name = "job", .work = {{3600.0, 4600.0}}, .places = {{.time_s = 0.0}, {.time_s = 3600.0}}};
  const double tolerance_um = 1.96 * 5.0 * std::sqrt(1.0 - std::exp(-1000.0 / 3600.0)) * 1.01;
  const auto plan = fewest_probings(job, axis, tolerance_um);
  ASSERT_TRUE(plan);
  EXPECT_THAT(places_of(*plan), testing::ElementsAre(1));
  EXPECT_DOUBLE_EQ(plan->lost_s, 0.0);
  EXPECT_DOUBLE_EQ(plan->probings[0].before_um, 1.96 * 5.0);
  job.places[1].time_s = 200.0;  // 200 s of rest before a probing of 300 s
  EXPECT_DOUBLE_EQ(judged_probings(job, axis, std::vector<std::size_t>{1}).lost_s, 100.0);
}

// One or two probings do not help here, because the variance grows back to that of the process; one before each 1200 s is
// needed, and then the half width is that of the longest time without one.
TEST(ProbePlan, SaysTheLeastThatAnyNumberReaches) {
  const ProbedAxis axis{.process = {5.0, 1600.0}, .probe = {.noise_um = 1e-6}};
  std::vector<double> places_s;
  for (int k = 0; k < 30; ++k) places_s.push_back(1200.0 * k);
  const ProbePlan plan = plan_probings(job_with(36000.0, places_s), axis, 4.0, 0.0);
  EXPECT_FALSE(plan.best);
  ASSERT_TRUE(plan.nearest);
  EXPECT_NEAR(plan.nearest->worst_um, 1.96 * 5.0 * std::sqrt(1.0 - std::exp(-1.5)), 1e-6);
  EXPECT_EQ(plan.nearest->probings.size(), 30U);
  ASSERT_EQ(plan.curve.size(), 31U);
  EXPECT_NEAR(plan.curve[2].best.worst_um, 1.96 * 5.0, 1e-5);
  EXPECT_NEAR(plan.curve.back().best.worst_um, plan.nearest->worst_um, 1e-5);
}

TEST(ProbePlan, EqualIntervalsProbeEachPlaceBeforeOneIsProbedAgain) {
  const ProbedAxis axis{.process = {5.0, 7200.0}, .probe = {.noise_um = 0.5}, .is_known_at_start = true};
  const ProbeJob job = job_with(6000.0, {500.0, 600.0, 5000.0});
  EXPECT_THAT(places_of(equal_probings(job, axis, 2)), testing::ElementsAre(1, 2));        // due at 2000 and 4000 s
  EXPECT_THAT(places_of(equal_probings(job, axis, 3)), testing::ElementsAre(0, 1, 2));     // 1500, 3000, 4500
  EXPECT_THAT(places_of(equal_probings(job, axis, 4)), testing::ElementsAre(0, 1, 2, 2));  // 1200, 2400, 3600, 4800
}

TEST(ProbePlan, SaysWhereNoNumberIsEnough) {
  const ProbedAxis axis{.process = {5.0, 7200.0}, .probe = {.noise_um = 0.5}, .is_known_at_start = true};
  const ProbeJob job = job_with(10000.0, {1000.0, 2000.0});  // 8000 s at the end without a place
  const ProbePlan plan = plan_probings(job, axis, 6.0, 0.0);
  EXPECT_FALSE(plan.best);
  EXPECT_EQ(plan.equal(), nullptr);
  EXPECT_GT(plan.curve.back().best.worst_um, 6.0);
  EXPECT_DOUBLE_EQ(plan.curve.back().best.worst_s, 10000.0);
  EXPECT_TRUE(plan_probings(job, axis, 20.0, 0.0).best->probings.empty());
  EXPECT_FALSE(fewest_probings(job_with(10000.0, {}), axis, 6.0));
}

// Of each tolerance a share stays free: half of 12 µm plans as 6 µm do.
TEST(ProbePlan, AShareOfTheToleranceStaysFree) {
  const ProbedAxis axis{.process = {5.0, 7200.0}, .probe = {.noise_um = 0.5}, .is_known_at_start = true};
  std::vector<double> places_s;
  for (int k = 1; k < 20; ++k) places_s.push_back(500.0 * k);
  const ProbeJob job = job_with(10000.0, places_s);
  const ProbePlan half = plan_probings(job, axis, 12.0, 0.5), whole = plan_probings(job, axis, 6.0, 0.0);
  ASSERT_TRUE(half.best && whole.best && half.equal());
  EXPECT_EQ(places_of(*half.best), places_of(*whole.best));
  EXPECT_GT(half.best->probings.size(), 1U);
  for (std::size_t k = 1; k < half.curve.size(); ++k)
    EXPECT_LE(half.curve[k].best.worst_um, half.curve[k - 1].best.worst_um) << k;
}

TEST(ProbePlan, TakesTheWiderOfBothIntervals) {
  compensation::DeployedPredictor predictor;
  predictor.from_start = true;
  EXPECT_THROW((void)probed_axis(predictor, {}, 60.0), std::logic_error);
  predictor.residual = compensation::ResidualProcess{2.0, 3600.0};
  EXPECT_DOUBLE_EQ(probed_axis(predictor, {}, 60.0).factor, 1.96);
  predictor.interval_um = 6.0;
  EXPECT_DOUBLE_EQ(probed_axis(predictor, {}, 60.0).factor, 3.0);
  predictor.interval_um = 1.0;
  EXPECT_DOUBLE_EQ(probed_axis(predictor, {}, 60.0).factor, 1.96);
  EXPECT_TRUE(probed_axis(predictor, {}, 60.0).is_known_at_start);
}

}  // namespace
}  // namespace driftwright::studies::probe_plan_test
