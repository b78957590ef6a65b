// Warm-ups against closed forms of one and two bodies.

#include "studies/warm_up.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "studies/warm_up_error.hpp"
#include "studies/warm_up_program.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::studies::warm_up_test {
namespace {

using ::testing::HasSubstr, ::testing::ThrowsMessage;

// 20 K at 1000 rpm, 4000 s, 1 um/K.
constexpr const char* kOneBody = R"(name: one_body
reference_temperature: 20 degC
ambient: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: body, capacity: 20 kJ/K}
  - {type: heat_source, node: body, power: 100 W, at_speed: 1000 rpm, exponent: 1}
  - {type: link, node: body, to: ambient, conductance: 5 W/K}
sensors: [{name: t_body, node: body}]
displacements: [{name: nose, sensitivities: [{node: body, sensitivity: 1 um/K}]}]
cyclograms:
  job: [[120 min, 600 rpm]]
  before: [[30 min, 1000 rpm]]
)";

WarmUpPlan planned(const std::string& text, const WarmUpOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(write_file("warm_up.yaml", text));
  return plan_warm_up(scenario, scenario.cyclogram("job"), options, {});
}

// The job ends at 12 K and goes 1 - e^-1.8 of the way there: it drifts by 3 um from 8.406 K on, which 1000 rpm reach
// after 2181 s.
TEST(WarmUp, OfOneBodyIsTheFastestSpeedUntilTheJobsOwnWarmthIsNear) {
  const WarmUpPlan plan = planned(kOneBody, {.tolerance_um = 3.0});
  const double needed_K = 12.0 - 3.0 / (1.0 - std::exp(-7200.0 / 4000.0));
  const double least_s = -4000.0 * std::log(1.0 - needed_K / 20.0);
  EXPECT_NEAR(least_s, 2181.0, 1.0);
  EXPECT_FALSE(plan.at_once.is_enough);
  EXPECT_NEAR(plan.at_once.peak_um, 12.0 * (1.0 - std::exp(-1.8)), 0.01);
  EXPECT_FALSE(plan.at_rest.is_enough);
  for (const WarmUp* way : {&plan.constant, &plan.staged}) {
    EXPECT_TRUE(way->is_enough);
    EXPECT_NEAR(way->duration_s(), least_s, 0.006 * least_s + 1.0) << way->way;
    EXPECT_EQ(way->sections.front().drive.speed_rpm, 1000.0);
    EXPECT_LE(way->peak_um, 3.0);
  }
  // The job warms for as long as one part, and from then on drifts by e^-1.8 of what it did: enough after one.
  EXPECT_TRUE(plan.by_jobs.is_enough);
  EXPECT_NEAR(plan.by_jobs.duration_s(), 7200.0, 1e-6);
  EXPECT_NEAR(plan.by_jobs.peak_um, 12.0 * std::exp(-1.8) * (1.0 - std::exp(-1.8)), 0.01);
  ASSERT_GT(plan.levels.size(), 3u);
  for (std::size_t i = 1; i < plan.levels.size(); ++i) {
    EXPECT_LE(plan.levels[i].staged_um, plan.levels[i].constant_um);
    EXPECT_LE(plan.levels[i].constant_um, plan.levels[i - 1].constant_um + 1e-9);
  }
}

TEST(WarmUp, GoesOnFromWhatWasBeforeAndTheRestBehindIt) {
  const WarmUpPlan plan = planned(kOneBody, {.from = {.start = "before", .after_pause = "20 min"}, .tolerance_um = 3.0});
  const double now_K = 20.0 * (1.0 - std::exp(-1800.0 / 4000.0)) * std::exp(-1200.0 / 4000.0);
  const double needed_K = 12.0 - 3.0 / (1.0 - std::exp(-1.8));
  const double least_s = 4000.0 * std::log((20.0 - now_K) / (20.0 - needed_K));
  EXPECT_NEAR(plan.staged.duration_s(), least_s, 0.006 * least_s + 1.0);
  const WarmUpPlan cold = planned(kOneBody, {.from = {.start = "before", .after_pause = "10 h"}, .tolerance_um = 3.0});
  EXPECT_NEAR(cold.staged.duration_s(), 2181.0, 15.0);
}

TEST(WarmUp, OfAMachineThatIsTooWarmIsRest) {  // 20 K from before, and a job that keeps it cold
  std::string text = kOneBody;
  text.replace(text.find("600 rpm"), 7, "100 rpm");
  text.replace(text.find("[[30 min"), 8, "[[20 h");
  const WarmUpPlan plan = planned(text, {.from = {.start = "before"}, .tolerance_um = 3.0});
  const double needed_K = 2.0 + 3.0 / (1.0 - std::exp(-1.8));
  EXPECT_TRUE(plan.at_rest.is_enough);
  EXPECT_NEAR(plan.at_rest.duration_s(), 4000.0 * std::log(20.0 / needed_K), 30.0);
  EXPECT_LE(plan.staged.duration_s(), 1.006 * plan.at_rest.duration_s() + 1.0);
}

// At 10000 rpm the body passes from 0.24 K below what the job keeps to 0.24 K above it in ten seconds.
TEST(WarmUp, FindsTheMomentBetweenTooColdAndTooWarm) {
  const WarmUpPlan plan = planned(kOneBody, {.tolerance_um = 0.2, .most_speed_rpm = 10000.0});
  const double least_s = -4000.0 * std::log(1.0 - (12.0 - 0.2 / (1.0 - std::exp(-1.8))) / 200.0);
  for (const WarmUp* way : {&plan.constant, &plan.staged}) {
    EXPECT_TRUE(way->is_enough) << way->way;
    EXPECT_NEAR(way->duration_s(), least_s, 2.0 + 0.006 * least_s) << way->way;
  }
}

// Too warm for any speed.
TEST(WarmUp, IsRestWhereNoSpeedIsEnough) {
  std::string text = kOneBody;
  text.replace(text.find("600 rpm"), 7, "0 rpm  ");
  text.replace(text.find("[[30 min"), 8, "[[20 h");
  const WarmUpPlan plan = planned(text, {.from = {.start = "before"}, .tolerance_um = 3.0, .most_speed_rpm = 12000.0});
  EXPECT_TRUE(plan.at_rest.is_enough);
  EXPECT_TRUE(plan.staged.is_enough);
  EXPECT_LE(plan.staged.duration_s(), plan.at_rest.duration_s());
}

// An ambient that turns warm after an hour and a half: what is enough earlier is not later, and minutes against
// micrometres say the same as the plan.
TEST(WarmUp, IsNoLongerThanAnyThatIsShownToBeEnough) {
  std::string text = kOneBody;
  text.replace(text.find("ambient: 20 degC"), 16, "ambient: [[0 min, 20 degC], [90 min, 20 degC], [100 min, 24 degC]]");
  for (double tolerance_um : {0.5, 4.0}) {
    const WarmUpPlan plan = planned(text, {.tolerance_um = tolerance_um});
    bool is_shown = false;
    for (const WarmUpLevel& level : plan.levels) {
      const bool is_enough = level.staged_um <= tolerance_um;
      is_shown = is_shown || is_enough;
      EXPECT_TRUE(!is_enough || plan.staged.duration_s() <= level.duration_s + 1.0)
          << tolerance_um << " um, " << level.duration_s;
      EXPECT_TRUE(plan.staged.is_enough || 0.99 * plan.staged.peak_um <= level.staged_um)
          << tolerance_um << " um, " << level.duration_s;
    }
    EXPECT_TRUE(plan.staged.is_enough || !is_shown) << tolerance_um;
  }
}

TEST(WarmUp, KeepsAMarginFreeAndAsksForNothingWhereTheJobIsWithinItAtOnce) {
  const WarmUpPlan plan = planned(kOneBody, {.tolerance_um = 4.0, .kept_free = 0.25});
  EXPECT_LE(plan.staged.peak_um, 3.0);
  EXPECT_NEAR(plan.staged.duration_s(), 2181.0, 15.0);
  const WarmUpPlan none = planned(kOneBody, {.tolerance_um = 15.0});
  EXPECT_TRUE(none.at_once.is_enough);
  EXPECT_TRUE(none.staged.sections.empty());
}

// A spindle that warms in 8 min on a column that takes hours: full speed makes the column warm and the spindle too warm,
// which a second speed mends.
constexpr const char* kTwoBodies = R"(name: two_bodies
reference_temperature: 20 degC
ambient: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 5 kJ/K}
  - {type: node, node: column, capacity: 30 kJ/K}
  - {type: heat_source, node: spindle, power: 200 W, at_speed: 1000 rpm, exponent: 1}
  - {type: link, node: spindle, to: column, conductance: 10 W/K}
  - {type: link, node: column, to: ambient, conductance: 8 W/K}
sensors: [{name: t_spindle, node: spindle}]
displacements: [{name: nose, sensitivities: [{node: spindle, sensitivity: 1 um/K}, {node: column, sensitivity: 1 um/K}]}]
cyclograms:
  job: [[180 min, 400 rpm]]
  fast: [[1 min, 1000 rpm]]
solver: {relative_tolerance: 1e-7, absolute_tolerance: 1e-6 K}
)";

/// The same two bodies by eigenvectors.
class TwoBodies {
 public:
  TwoBodies() {
    Eigen::Matrix2d k;
    k << 10.0 / 5e3, -10.0 / 5e3, -10.0 / 30e3, 18.0 / 30e3;
    const Eigen::EigenSolver<Eigen::Matrix2d> of(k);
    rate_ = of.eigenvalues().real();
    v_ = of.eigenvectors().real();
    inverse_ = v_.inverse();
    steady_at_1000_ = k.inverse() * Eigen::Vector2d(200.0 / 5e3, 0.0);
  }
  [[nodiscard]] Eigen::Vector2d after(const Eigen::Vector2d& from_K, double speed_rpm, double time_s) const {
    const Eigen::Vector2d end = speed_rpm / 1000.0 * steady_at_1000_, decay = (-rate_ * time_s).array().exp();
    return end + v_ * (decay.cwiseProduct(inverse_ * (from_K - end)));
  }
  [[nodiscard]] double peak_um(const Eigen::Vector2d& start_K) const {
    double peak = 0.0;
    for (int minute = 1; minute <= 180; ++minute)
      peak = std::max(peak, std::abs(after(start_K, 400.0, 60.0 * minute).sum() - start_K.sum()));
    return peak;
  }

 private:
  Eigen::Vector2d rate_, steady_at_1000_;
  Eigen::Matrix2d v_, inverse_;
};

TEST(WarmUpAtLength, OfTwoBodiesIsTheShortestOfAllTriedOneByOne) {
  const WarmUpPlan plan = planned(kTwoBodies, {.tolerance_um = 3.0});
  ASSERT_TRUE(plan.constant.is_enough);
  ASSERT_TRUE(plan.staged.is_enough);
  const TwoBodies machine;
  Eigen::Vector2d state_K = Eigen::Vector2d::Zero();
  for (const auto& section : plan.staged.sections)
    state_K = machine.after(state_K, section.drive.speed_rpm, section.duration_s);
  EXPECT_NEAR(machine.peak_um(state_K), plan.staged.peak_um, 0.01);

  double least_s = 1e9;
  for (double time_s = 60.0; time_s < plan.constant.duration_s() && least_s > 1e8; time_s += 15.0) {
    for (int i = 1; i <= 20; ++i) {
      for (int share = 1; share < 25; ++share) {
        const Eigen::Vector2d first_K = machine.after({0.0, 0.0}, 50.0 * i, time_s * share / 25.0);
        for (int j = 0; j <= 20; ++j) {
          if (machine.peak_um(machine.after(first_K, 50.0 * j, time_s * (25 - share) / 25.0)) <= 3.0) least_s = time_s;
        }
      }
    }
  }
  EXPECT_LE(plan.staged.duration_s(), 1.02 * least_s);
  EXPECT_LT(plan.staged.duration_s(), 0.95 * plan.constant.duration_s());
  double one_s = 1e9;
  for (double time_s = 60.0; time_s < 7200.0 && one_s > 1e8; time_s += 2.0) {
    for (int i = 1; i <= 100; ++i) {
      if (machine.peak_um(machine.after({0.0, 0.0}, 10.0 * i, time_s)) <= 3.0) one_s = time_s;
    }
  }
  EXPECT_LE(plan.constant.duration_s(), 1.02 * one_s);
}

// A light spindle, a head that pulls the other way, and a heavy column: three bodies take up to three sections
// (Pontryagin: a section a body).
constexpr const char* kThreeBodies = R"(name: three_bodies
reference_temperature: 20 degC
ambient: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 2 kJ/K}
  - {type: node, node: head, capacity: 10 kJ/K}
  - {type: node, node: column, capacity: 60 kJ/K}
  - {type: heat_source, node: spindle, power: 200 W, at_speed: 1000 rpm, exponent: 1}
  - {type: link, node: spindle, to: head, conductance: 10 W/K}
  - {type: link, node: head, to: column, conductance: 10 W/K}
  - {type: link, node: column, to: ambient, conductance: 8 W/K}
sensors: [{name: t_spindle, node: spindle}]
displacements:
  - {name: nose, sensitivities: [{node: spindle, sensitivity: 5 um/K}, {node: head, sensitivity: -5 um/K}, {node: column, sensitivity: 3 um/K}]}
cyclograms:
  job: [[180 min, 400 rpm]]
  fast: [[1 min, 1000 rpm]]
)";

TEST(WarmUp, OfThreeBodiesIsShorterWithThreeSpeedsThanWithTwo) {
  const WarmUpPlan plan = planned(kThreeBodies, {.from = {.model = "reduced"}, .tolerance_um = 1.0});
  ASSERT_TRUE(plan.staged.is_enough);
  ASSERT_TRUE(plan.finest.has_value());
  EXPECT_GE(plan.finest->sections.size(), 3u);
  EXPECT_LE(plan.finest->sections.size(), 4u);
  EXPECT_LT(plan.finest->duration_s(), 0.99 * plan.staged.duration_s());
  double peak_um = 0.0;  // by the whole run, not by what the search ran
  for (double value_um : plan.job_warm.at("nose").values) peak_um = std::max(peak_um, std::abs(value_um));
  EXPECT_NEAR(peak_um, plan.finest->peak_um, 1e-6);
  EXPECT_LE(peak_um, 1.0);
}

// 100 W at 1000 rpm, in proportion: 70 W are 700 rpm, of which the body is 14 K warm in the end.
TEST(WarmUp, KeepsALimitOfHeat) {
  const WarmUpPlan plan = planned(kOneBody, {.tolerance_um = 3.0, .most_power_W = 70.4});
  EXPECT_EQ(plan.most_speed_rpm, 700.0);
  EXPECT_NEAR(plan.power_at_most_W, 70.0, 1e-9);
  const double needed_K = 12.0 - 3.0 / (1.0 - std::exp(-7200.0 / 4000.0)),
               least_s = -4000.0 * std::log(1.0 - needed_K / 14.0);
  EXPECT_NEAR(plan.best().duration_s(), least_s, 0.006 * least_s + 1.0);
  EXPECT_THAT([] { (void)planned(kOneBody, {.most_power_W = 0.5}); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("--power-limit"), HasSubstr("10 rpm brings 1 W"))));
}

// Source times a, link times c: 12 a/c K at 600 rpm, time constant 4000 s / c.
TEST(WarmUp, OnDrawnMachinesHasThePeaksOfTheClosedForm) {
  const scenarios::Scenario scenario = scenarios::read_scenario(write_file("warm_up.yaml", kOneBody));
  const Cyclogram& job = scenario.cyclogram("job");
  const WarmUpTrials trials(scenario, job, {.from = {.model = "reduced"}}, 1000.0, {});
  const Eigen::MatrixXd peaks = DrawnMachines(trials, 0.2, 11, 5).peaks_um({{}, {{1800.0, {.speed_rpm = 1000.0}}}}, {});
  for (int m = 0; m < 5; ++m) {
    Random random(static_cast<std::uint64_t>(11 + m), 7);
    const double a = std::exp(0.2 * random.normal()), c = std::exp(0.2 * random.normal()), rate = c / 4000.0;
    const double start_K = 20.0 * a / c * (1.0 - std::exp(-1800.0 * rate)), gone = 1.0 - std::exp(-7200.0 * rate);
    EXPECT_NEAR(peaks(0, m), 12.0 * a / c * gone, 1e-3) << m;
    EXPECT_NEAR(peaks(1, m), std::abs(12.0 * a / c - start_K) * gone, 1e-3) << m;
  }
}

// The margin is chosen on 200 machines; on 200 others at least as many keep the tolerance as 95 of 100 let expect (187 in
// 99 of 100 cases).
TEST(WarmUp, KeepsAsMuchFreeAsMachinesThatAreOffNeed) {
  const WarmUpPlan plan = planned(kOneBody, {.from = {.model = "reduced"}, .tolerance_um = 4.0, .model_error = 0.1});
  ASSERT_TRUE(plan.held.has_value());
  EXPECT_GT(plan.kept_free, 0.0);
  EXPECT_GE(plan.held->n_kept, 190);
  EXPECT_GE(plan.held->n_fresh_kept, 182);
  const WarmUpPlan none = planned(kOneBody, {.from = {.model = "reduced"}, .tolerance_um = 4.0});
  EXPECT_GT(plan.best().duration_s(), none.best().duration_s());
  EXPECT_REFUSED(planned(kOneBody, {.from = {.model = "reduced"}, .tolerance_um = 0.01, .model_error = 0.5}),
                 "--model-error");
}

/// Of all programmes of two speeds on a grid (16 speeds each, 20 shares) that take 98 % of the time found, none is enough.
void expect_no_shorter_one(const std::string& name, double tolerance_um) {
  const scenarios::Scenario scenario = scenarios::read_scenario("scenarios/" + name + ".yaml");
  const Cyclogram& job = scenario.cyclogram("chaotic");
  const WarmUpPlan plan = plan_warm_up(scenario, job, {.tolerance_um = tolerance_um}, {});
  ASSERT_TRUE(plan.staged.is_enough) << name;
  const WarmUpTrials trials(scenario, job, {}, plan.most_speed_rpm, {});
  for (double share : {0.98, 0.9, 0.75, 0.5}) {
    const double time_s = std::round(share * plan.staged.duration_s());
    std::vector<double> least_um(17 * 17, 1e9);
    parallel_for(least_um.size(), [&](std::size_t i) {
      const double first_rpm = plan.most_speed_rpm * static_cast<double>(i % 17) / 16.0,
                   second_rpm = plan.most_speed_rpm * static_cast<double>(i / 17) / 16.0;
      for (int k = 1; k <= 20; ++k) {
        const double first_s = std::round(time_s * k / 20.0);
        std::vector<Cyclogram::Section> sections = {{first_s, {.speed_rpm = first_rpm}}};
        if (k < 20) sections.push_back({time_s - first_s, {.speed_rpm = second_rpm}});
        least_um[i] = std::min(least_um[i], trials.tried(sections, tolerance_um).peak_um);
      }
    });
    EXPECT_GT(*std::min_element(least_um.begin(), least_um.end()), tolerance_um)
        << name << ", " << share << " of the time found";
  }
}

TEST(WarmUp, OfTheKneeMillIsWithinTwoPercentOfBruteForce) {
  expect_no_shorter_one("fp3_spindle", 12.0);
}

TEST(WarmUpAtLength, OfTheVerticalMillIsWithinTwoPercentOfBruteForce) {
  expect_no_shorter_one("cnc_mill_13", 20.0);
}

TEST(WarmUp, RefusesWhatCannotBe) {
  EXPECT_THAT([] { (void)planned(kOneBody, {.channels = {"nos"}}); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("--channel 'nos'"), HasSubstr("there are nose"))));
  std::string still = kOneBody;
  for (const char* speed : {"600 rpm", "1000 rpm]]"}) still.replace(still.find(speed), 4, "0   ");
  EXPECT_REFUSED(planned(still, {}), "--speed-limit");
}

TEST(WarmUp, IsWrittenAsAProgram) {
  EXPECT_THAT(warm_up_program({}, "before p) M3 S24000 (q\n;"), ::testing::StartsWith("(before p_ M3 S24000 _q__)\nG21"));
  EXPECT_EQ(warm_up_program({{600.0, {.speed_rpm = 2000.0}}, {90.0, {.speed_rpm = 500.0}}, {60.0, {}}}, "warm-up of a"),
            "(warm-up of a)\nG21 G94\nS2000 M3\nG4 P600 (10 min)\nS500\nG4 P90 (1.5 min)\nM5\nG4 P60 (1 min)\nM2\n");
}

}  // namespace
}  // namespace driftwright::studies::warm_up_test
