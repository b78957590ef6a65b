// The observer on a machine of three lumped parts, whose every run has a closed form or an exact propagation.

#include "compensation/predictors/observer.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "base/random.hpp"
#include "compensation/judging/model_scatter.hpp"
#include "compensation/predictors/observability.hpp"
#include "solver/propagator.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/three_parts.hpp"

namespace driftwright::compensation::observer_test {
namespace {

using fixtures::kWork, fixtures::run_of, fixtures::three_parts;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Observer observer_of(const solver::ReducedSystem& model, std::vector<std::string> sensors,
                     const ObserverSettings& settings = {}) {
  return Observer(model, Eigen::Vector3d::Zero(), 0.0, std::move(sensors), "drift_y", settings);
}
double worst_um(const std::vector<double>& drift_um, const MachineRun& run) {
  const std::vector<double>& truth = run.readings.at("drift_y").values;
  double worst = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    worst = std::max(worst, std::isfinite(drift_um[i]) ? std::abs(drift_um[i] - truth[i]) : INFINITY);
  return worst;
}
solver::ReducedSystem with_motor(double factor) {
  return solver::with_factors(three_parts(), {.source = {factor, 1.0}});
}

TEST(Observer, WithTheExactModelFollowsExactlyWithAndWithoutSensors) {
  const solver::ReducedSystem s = three_parts();
  for (const double warmer_K : {0.0, 7.0}) {
    const MachineRun run = run_of(s, 60.0, warmer_K);
    EXPECT_GT(run.readings.at("drift_y").values[60], 20.0);
    for (const std::vector<std::string>& sensors : {std::vector<std::string>{}, {"T1"}, {"T1", "T2", "T3"}}) {
      const Observation o = observer_of(s, sensors).observe(run);
      EXPECT_LT(worst_um(o.drift_um, run), 1e-8) << sensors.size();  // rounding of 293 K in 1e4 steps
      EXPECT_THAT(o.distrusted, IsEmpty());
      EXPECT_EQ(o.drift_um[0], 0.0);
    }
  }
}

// One part alone, C = 4e3, 6 W/K, 200 W: T = P/h (1 - exp(-h t/C)).
TEST(Observer, FollowsTheClosedFormOfOnePart) {
  solver::ReducedSystem s = three_parts();
  s.conduction.setZero();
  const MachineRun run = run_of(s, 60.0, 0.0, 0.0, 1, {.name = "on", .sections = {{7200, {.speed_rpm = 2000}}}});
  MachineRun closed = run;
  for (std::size_t i = 0; i < run.readings.n_samples(); ++i) {
    const double t = run.readings.time_s[i];
    closed.readings.channels[3].values[i] = 2.0 * 200.0 / 6.0 * (1.0 - std::exp(-6.0 * t / 4e3)) + 3.0 * 60.0 / 10e3 * t;
  }
  EXPECT_LT(worst_um(observer_of(s, {"T1"}).observe(run).drift_um, closed), 1e-8);
}

TEST(Observer, WithTheMotorOffByAFifthSensorsTakeMostOfTheErrorAway) {
  for (const double factor : {0.8, 1.2}) {
    const MachineRun run = run_of(with_motor(factor), 60.0, 0.0, 0.1);
    const double alone_um = worst_um(observer_of(three_parts(), {}).observe(run).drift_um, run);
    const Observation o = observer_of(three_parts(), {"T1", "T3"}).observe(run);
    EXPECT_GT(alone_um, 10.0);
    EXPECT_LT(worst_um(o.drift_um, run), 0.15 * alone_um) << factor;
    EXPECT_LT(std::abs(o.drift_um.back() - run.readings.at("drift_y").values.back()), 0.05 * alone_um);
    EXPECT_THAT(o.distrusted, IsEmpty());
  }
}

// A covariance that lost its symmetry or a sign would show as a deviation of 0 (it is cut there) or as none at all.
TEST(Observer, ItsCovarianceStaysPositiveWithReadingsFarBetterThanTheModel) {
  const MachineRun run = run_of(scattered(three_parts(), 0.1, 3), 10.0);
  ASSERT_GT(run.readings.n_samples(), 1400u);
  for (const double walk : {0.0, 0.02}) {
    const ObserverSettings sure{.reading_K = 1e-6, .model_K = 0.0, .drift_um = 1e-5, .factor_walk = walk};
    Observer o = observer_of(three_parts(), {"T1", "T2", "T3"}, sure);
    o.learn(std::vector<MachineRun>{run, run});
    for (const Observer::Factor& f : o.factors()) EXPECT_GT(f.deviation, 0.0) << f.name << walk;
    const Observation seen = o.observe(run);
    for (std::size_t i = 1; i < seen.deviation_um.size(); ++i) ASSERT_GT(seen.deviation_um[i], 0.0) << i << " " << walk;
  }
}

// 95 of 100 within two deviations would be ideal; within three all but a few must be.
TEST(Observer, ItsDeviationCoversItsError) {
  int n = 0, n_outside = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const MachineRun run = run_of(scattered(three_parts(), 0.1, static_cast<int>(seed)), 60.0, 0.0, 0.1, seed);
    const Observation o = observer_of(three_parts(), {"T1", "T3"}).observe(run);
    for (std::size_t i = 0; i < o.drift_um.size(); ++i) {
      ++n;
      EXPECT_TRUE(std::isfinite(o.deviation_um[i]) && o.deviation_um[i] >= 0.0);
      n_outside += std::abs(o.drift_um[i] - run.readings.at("drift_y").values[i]) > 3.0 * o.deviation_um[i] + 1e-9;
    }
  }
  EXPECT_LT(n_outside, n / 20);
}

TEST(Observer, LearnsTheFactorOfASourceAndTheScaleOfTheDrift) {
  solver::ReducedSystem machine = with_motor(1.2);
  machine.outputs.state.col(3) *= 1.06;
  const std::vector<MachineRun> training = {run_of(machine, 60.0, 0.0, 0.05, 1), run_of(machine, 60.0, 0.0, 0.05, 2)};
  Observer o = observer_of(three_parts(), {"T1", "T2", "T3"}, {.drift_um = 0.2});
  const auto before = o.factors();
  ASSERT_THAT(before, SizeIs(5));
  EXPECT_EQ(before[0].name, "motor");
  EXPECT_EQ(before[2].name, "film 1");
  EXPECT_EQ(before[4].name, "drift_y");
  o.learn(training);
  const auto after = o.factors();
  EXPECT_NEAR(after[0].value, 1.2, 0.04);
  EXPECT_NEAR(after[1].value, 1.0, 0.1);
  EXPECT_NEAR(after[4].value, 1.06, 0.01);
  for (std::size_t i = 0; i < after.size(); ++i) EXPECT_LT(after[i].deviation, before[i].deviation) << after[i].name;
  // what was learnt stays where there are no sensors, and follow() changes nothing
  const MachineRun judged = run_of(machine, 60.0, 0.0, 0.0, 3);
  const Observer blind = o.with_sensors({});
  EXPECT_LT(worst_um(blind.observe(judged).drift_um, judged),
            0.2 * worst_um(observer_of(three_parts(), {}).observe(judged).drift_um, judged));
  EXPECT_EQ(o.observe(judged).drift_um, o.observe(judged).drift_um);
}

// The drift counts from the start: what the machine was displaced by before, warm ambient or cold, is no part of it,
// whatever the scale.
TEST(Observer, LearnsTheScaleOfTheDriftInAWarmAmbientToo) {
  solver::ReducedSystem machine = three_parts();
  machine.outputs.state.col(3) *= 1.06;
  for (const double warmer_K : {10.0, -10.0}) {
    const std::vector<MachineRun> training = {run_of(machine, 60.0, warmer_K, 0.05, 1),
                                              run_of(machine, 60.0, warmer_K, 0.05, 2)};
    Observer o = observer_of(three_parts(), {"T1", "T2", "T3"});
    o.learn(training);
    EXPECT_NEAR(o.factors()[4].value, 1.06, 0.015) << warmer_K;
    const MachineRun cold = run_of(machine, 60.0, -warmer_K, 0.05, 3);
    EXPECT_LT(worst_um(o.observe(cold).drift_um, cold), 1.5) << warmer_K;  // 6 % of 90 um unlearnt
  }
}

TEST(Observer, DropsAndNamesASensorThatSticks) {
  for (const int stuck : {0, 2}) {
    const MachineRun whole = run_of(three_parts(), 60.0, 0.0, 0.1);
    MachineRun run = whole;
    std::vector<double>& x = run.readings.channels[static_cast<std::size_t>(stuck)].values;
    for (std::size_t i = 100; i < x.size(); ++i) x[i] = x[100] + 12.0;
    const Observation o = observer_of(three_parts(), {"T1", "T2", "T3"}).observe(run);
    ASSERT_THAT(o.distrusted, SizeIs(1)) << stuck;
    EXPECT_THAT(o.distrusted[0], HasSubstr(stuck == 0 ? "T1 from 1" : "T3 from 1"));
    const Observation without = observer_of(three_parts(), {"T1", "T2", "T3"}).observe(whole);
    EXPECT_LT(worst_um(o.drift_um, run), worst_um(without.drift_um, whole) + 1.0) << stuck;
  }
}

TEST(Observer, DropsASensorThatStaysBehindSlowly) {
  MachineRun run = run_of(three_parts(), 60.0, 0.0, 0.1);
  std::vector<double>& x = run.readings.channels[0].values;
  for (std::size_t i = 91; i < x.size(); ++i) x[i] = x[90];  // as the motor starts again
  const Observation o = observer_of(three_parts(), {"T1", "T2", "T3"}).observe(run);
  ASSERT_GE(o.distrusted.size(), 1u);
  EXPECT_THAT(o.distrusted[0], HasSubstr("T1"));
  EXPECT_LT(std::abs(o.drift_um.back() - run.readings.at("drift_y").values.back()), 2.0);
}

TEST(Observer, MissingReadingsDoNoHarm) {
  const solver::ReducedSystem machine = with_motor(1.2);
  const MachineRun whole = run_of(machine, 60.0, 0.0, 0.1);
  const double alone_um = worst_um(observer_of(three_parts(), {}).observe(whole).drift_um, whole);
  MachineRun run = whole;
  double mean_um = 0.0;
  constexpr int kDraws = 10;
  for (int seed = 1; seed <= kDraws; ++seed) {
    run = whole;
    Random random(static_cast<std::uint64_t>(seed));
    for (std::size_t j = 0; j < 2; ++j) {
      for (double& v : run.readings.channels[j].values) {
        if (random.chance(0.3)) v = NAN;
      }
    }
    run.readings.channels[0].values[0] = NAN;
    const Observation o = observer_of(three_parts(), {"T1", "T2"}).observe(run);
    EXPECT_THAT(o.distrusted, IsEmpty()) << seed;
    mean_um += worst_um(o.drift_um, run) / kDraws;
  }
  EXPECT_LT(mean_um, 0.15 * alone_um);  // as with all readings
  for (Channel& c : run.readings.channels) {
    if (c.name != "drift_y") std::fill(c.values.begin(), c.values.end(), NAN);
  }
  EXPECT_EQ(observer_of(three_parts(), {"T1"}).observe(run).drift_um, observer_of(three_parts(), {}).observe(run).drift_um);
}

TEST(Observer, LearnsFromARunWhoseFirstDriftIsMissing) {
  const solver::ReducedSystem machine = with_motor(1.2);
  std::vector<MachineRun> training = {run_of(machine, 60.0, 0.0, 0.05)};
  for (std::size_t i = 0; i < 3; ++i) training[0].readings.channels[3].values[i] = NAN;
  for (double& v : training[0].readings.channels[3].values) v -= 2.5;  // and counts from somewhere else
  Observer o = observer_of(three_parts(), {"T1", "T2", "T3"});
  o.learn(training);
  for (const Observer::Factor& f : o.factors()) EXPECT_TRUE(std::isfinite(f.value) && std::isfinite(f.deviation)) << f.name;
  EXPECT_NEAR(o.factors()[0].value, 1.2, 0.05);
}

// What it says of a row is what it would have said had the run ended there, sensors dropped on the way included.
TEST(Observer, RowByRowSaysTheSameAsOfTheWholeRun) {
  MachineRun run = run_of(with_motor(1.2), 60.0, 0.0, 0.05);
  for (std::size_t i = 90; i < run.readings.n_samples(); ++i) run.readings.channels[0].values[i] += 15.0;  // fell off
  const Observer o = observer_of(three_parts(), {"T1", "T3"});
  const Observation whole = o.observe(run);
  ASSERT_THAT(whole.distrusted, SizeIs(1));
  EXPECT_EQ(live(o, run), whole.drift_um);
  for (const std::size_t n : {2, 50, 95, 120}) {
    MachineRun cut = run;
    cut.readings.time_s.resize(n);
    for (Channel& c : cut.readings.channels) c.values.resize(n);
    const std::vector<double> so_far = live(o, cut);
    EXPECT_EQ(so_far, std::vector<double>(whole.drift_um.begin(), whole.drift_um.begin() + static_cast<std::ptrdiff_t>(n)));
  }
}

// An ambient thermometer whose plug is exchanged for a warm one: its last reading holds, and it counts again once it is
// back.
TEST(Observer, AnAmbientThatJumpsIsHeld) {
  const MachineRun run = run_of(three_parts(), 60.0, 4.0);
  MachineRun exchanged = run;
  exchanged.ambient = {{0.0, 3599.0, 3600.0, 7200.0, 7201.0}, {4.0, 4.0, 19.0, 26.0, 4.0}};
  for (const std::vector<std::string>& sensors : {std::vector<std::string>{}, {"T1", "T3"}}) {
    const Observation o = observer_of(three_parts(), sensors).observe(exchanged);
    EXPECT_LT(worst_um(o.drift_um, run), 1e-8) << sensors.size();
    EXPECT_THAT(o.distrusted, ElementsAre(HasSubstr("the ambient thermometer from 60 min")));
  }
  MachineRun slow = run;  // what is slower is an ambient
  slow.ambient = {{0.0, 3600.0, 7200.0}, {4.0, 4.0, 26.0}};
  EXPECT_THAT(observer_of(three_parts(), {}).observe(slow).distrusted, IsEmpty());
  EXPECT_GT(worst_um(observer_of(three_parts(), {}).observe(slow).drift_um, run), 1.0);
}

TEST(Observer, ASensorInAnotherUnitIsRefused) {
  MachineRun run = run_of(three_parts());
  run.readings.channels[0].unit = "K";
  EXPECT_REFUSED(live(observer_of(three_parts(), {"T1"}), run), "in degC");
}

// Before the run there are no readings: the model with what it has learnt.
TEST(Observer, AheadItIsTheModelWithItsFactors) {
  const MachineRun run = run_of(with_motor(1.2));
  Observer o = observer_of(three_parts(), {"T1", "T3"});
  o.learn(std::vector<MachineRun>{run, run});
  EXPECT_EQ(ahead(o, {run.cyclogram, run.ambient, {.source = {}, .time_s = run.readings.time_s, .channels = {}}}),
            o.with_sensors({}).observe(run).drift_um);
}

// Twice the rows are twice the readings, whose noise is taken for white; without noise the states agree but for the
// linearised factors.
TEST(Observer, TwiceAsDenseRowsTellTheSame) {
  const solver::ReducedSystem machine = with_motor(1.2);
  const MachineRun coarse = run_of(machine, 60.0), dense = run_of(machine, 30.0);
  const std::vector<double> a = observer_of(three_parts(), {}).observe(coarse).drift_um,
                            b = observer_of(three_parts(), {}).observe(dense).drift_um;
  const std::vector<double>
      c = observer_of(three_parts(), {"T1", "T3"}, {.reading_K = 0.1}).observe(coarse).drift_um,
      d = observer_of(three_parts(), {"T1", "T3"}, {.reading_K = 0.1 * std::sqrt(2.0)}).observe(dense).drift_um;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i], b[2 * i], 1e-9);
    EXPECT_NEAR(c[i], d[2 * i], 0.8);  // of a drift error of 12 um without sensors
  }
}

// With films learnt off their values, K(u) has what the model has and heat over a step the rest: first order in the step.
TEST(Observer, FactorsOnFilmsAreOfFirstOrderInTheStep) {
  const solver::ReducedSystem machine = solver::with_factors(three_parts(), {.exchange = {1.3, 1.3}});
  std::vector<MachineRun> training = {run_of(machine, 60.0), run_of(machine, 60.0)};
  for (const double step_s : {60.0, 30.0, 15.0}) {
    Observer o = observer_of(
        three_parts(), {"T1", "T2", "T3"},
        {.reading_K = 1e-3, .model_K = 1e-3, .drift_um = 0.01, .factor = 0.3, .factor_walk = 0.0, .longest_step_s = step_s});
    o.learn(training);
    EXPECT_NEAR(o.factors()[2].value, 1.3, 0.02);
    EXPECT_NEAR(o.factors()[3].value, 1.3, 0.02);
  }
}

// What the filter has learnt is a machine of its own: without sensors both run alike, but for films that act as heat over
// a step.
TEST(Observer, BelievesInTheMachineThatItsFactorsMake) {
  const solver::ReducedSystem machine =
      solver::with_factors(three_parts(), {.source = {1.2, 0.9}, .exchange = {1.3, 0.8}, .output = {1.0, 1.0, 1.0, 1.1}});
  std::vector<double> off_by_step_um;
  for (const double step_s : {60.0, 30.0}) {
    Observer o = observer_of(three_parts(), {"T1", "T2", "T3"},
                             {.drift_um = 0.1, .model_um = 0.1, .factor_walk = 0.0, .longest_step_s = step_s});
    o.learn(std::vector<MachineRun>{run_of(machine), run_of(machine)});
    std::vector<std::string> names;
    std::vector<double> value;
    for (const Observer::Factor& f : o.factors()) {
      names.push_back(f.name);
      value.push_back(f.value);
      EXPECT_GT(std::abs(f.value - 1.0), 0.03) << f.name;
    }
    EXPECT_THAT(names, ElementsAre("motor", "screw", "film 1", "film 3", "drift_y"));
    const solver::ReducedSystem believed = solver::with_factors(
        three_parts(),
        {.source = {value[0], value[1]}, .exchange = {value[2], value[3]}, .output = {1.0, 1.0, 1.0, value[4]}});
    const MachineRun run = run_of(believed, 60.0, 7.0);
    EXPECT_GT(worst_um(observer_of(three_parts(), {}).observe(run).drift_um, run), 5.0);
    const double off_um = worst_um(o.with_sensors({}).observe(run).drift_um, run);
    EXPECT_LT(off_um, 0.5);
    off_by_step_um.push_back(off_um);
  }
  EXPECT_NEAR(off_by_step_um[1] / off_by_step_um[0], 0.5, 0.1);  // of first order in the step
}

TEST(Observer, RefusesWhatTheModelHasNot) {
  EXPECT_REFUSED(observer_of(three_parts(), {"T9"}), "no output 'T9'");
  solver::ReducedSystem looks = three_parts();
  looks.sources[0].power_W.probes = {0};
  EXPECT_THROW((void)observer_of(looks, {}), std::logic_error);
  const MachineRun run = run_of(three_parts());
  MachineRun less = run;
  less.readings.channels.erase(less.readings.channels.begin());
  EXPECT_THROW((void)observer_of(three_parts(), {"T1"}).observe(less), InputError);
}

// Only the motor's heat is uncertain and only the drift's part 1 matters: T1 shows most. By hand, one factor f of
// deviation s: with sensitivities y and d, what is left is s^2 d^2 r^2 / (s^2 y^2 + r^2) -> the sensor with the largest
// |y|.
TEST(Observability, TakesTheSensorThatSeesWhatIsUncertain) {
  solver::ReducedSystem s = three_parts();
  s.sources.resize(1);
  s.exchanges.resize(1);
  const std::vector<MachineRun> runs = {run_of(three_parts())};
  const ObserverSettings settings{.reading_K = 0.3, .model_K = 0.4, .factor = 0.2};
  const Selection first =
      select_by_observability(s, Eigen::Vector3d::Zero(), runs, {"T3", "T2", "T1"}, "drift_y", 1, settings);
  EXPECT_THAT(first.sensors, ElementsAre("T1"));
  const Selection all =
      select_by_observability(s, Eigen::Vector3d::Zero(), runs, {"T3", "T2", "T1"}, "drift_y", 9, settings);
  EXPECT_THAT(all.sensors, SizeIs(3));
  EXPECT_REFUSED(select_by_observability(s, Eigen::Vector3d::Zero(), runs, {"T9"}, "drift_y", 1), "'T9'");
  EXPECT_REFUSED(select_by_observability(s, Eigen::Vector3d::Zero(), {}, {"T1"}, "drift_y", 1), "fewer than 11 rows");
}

// One source alone: outputs are linear in its factor, so J is s y(t) and what is left has the closed form above.
TEST(Observability, LeavesTheVarianceOfTheClosedForm) {
  solver::ReducedSystem s = three_parts();
  s.sources.resize(1);
  Eigen::MatrixXd k = s.conduction;
  for (const auto& e : s.exchanges) k += e.coefficient({}) * e.matrix;
  s.conduction = k;
  s.exchanges.clear();
  const std::vector<MachineRun> runs = {run_of(s)};
  const double sigma = 0.2, noise = 0.25;
  const Record& r = runs[0].readings;
  double alone = 0.0, with = 0.0, n = 0.0;
  for (std::size_t i = 10; i < r.n_samples(); i += 10) {
    const double d = sigma * r.at("drift_y").values[i], y = sigma * (r.at("T1").values[i] - 20.0);
    alone += d * d;
    with += d * d * noise / (y * y + noise);
    n += 1.0;
  }
  const Selection one = select_by_observability(s, Eigen::Vector3d::Zero(), runs, {"T1"}, "drift_y", 1,
                                                {.reading_K = 0.3, .model_K = 0.4, .factor = sigma});
  EXPECT_THAT(one.reason, HasSubstr(fmt::format("{:.2f}, {:.2f} um", std::sqrt(alone / n), std::sqrt(with / n))));
}

// Results of studies hang on the order of the draws.
TEST(Scattered, DrawsSourcesThenExchangesThenConductionThenRates) {
  const solver::ReducedSystem s = three_parts(), a = scattered(s, 0.1, 4, true);
  Random random(4, 2);
  std::vector<double> factor;
  for (int i = 0; i < 6; ++i) factor.push_back(std::exp(0.1 * random.normal()));
  const solver::ReducedSystem expected = solver::with_factors(
      s, {.source = {factor[0], factor[1]}, .exchange = {factor[2], factor[3]}, .conduction = factor[4], .rate = factor[5]});
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(a.sources[i].load, expected.sources[i].load);
    EXPECT_EQ(a.exchanges[i].matrix, expected.exchanges[i].matrix);
  }
  EXPECT_EQ(a.conduction, expected.conduction);
  EXPECT_EQ(a.mass, s.mass);
}

TEST(Scattered, MultipliesHeatAndFilmsAndIsTheSameForASeed) {
  const solver::ReducedSystem s = three_parts(), a = scattered(s, 0.1, 4), b = scattered(s, 0.1, 4),
                              c = scattered(s, 0.1, 5), none = scattered(s, 0.0, 4);
  EXPECT_EQ(a.sources[0].load, b.sources[0].load);
  EXPECT_NE(a.sources[0].load, c.sources[0].load);
  EXPECT_EQ(none.sources[0].load, s.sources[0].load);
  for (std::size_t e = 0; e < 2; ++e) {
    const double f = a.exchanges[e].ambient_sum / s.exchanges[e].ambient_sum;
    EXPECT_NE(f, 1.0);
    EXPECT_LT((a.exchanges[e].matrix - f * s.exchanges[e].matrix).norm(), 1e-15);
    EXPECT_LT((a.exchanges[e].to_ambient - f * s.exchanges[e].to_ambient).norm(), 1e-15);
    EXPECT_LT((a.exchanges[e].flow - f * s.exchanges[e].flow).norm(), 1e-15);
  }
}

}  // namespace
}  // namespace driftwright::compensation::observer_test
