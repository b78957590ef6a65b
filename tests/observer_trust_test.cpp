// An observer whose model is wrong says so: trust falls, the interval grows, the correction fades. One whose model is
// right is trusted.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/median.hpp"
#include "base/random.hpp"
#include "compensation/judging/model_scatter.hpp"
#include "compensation/predictors/deployed_follower.hpp"
#include "compensation/predictors/observer.hpp"
#include "compensation/predictors/score.hpp"
#include "solver/model_factors.hpp"
#include "tests/three_parts.hpp"

namespace driftwright::compensation::observer_trust_test {
namespace {

using fixtures::run_of;
using fixtures::three_parts;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kNoise_K = 0.1;

/// A working day of random speeds.
Cyclogram day(std::uint64_t seed) {
  Random random(seed, 17);
  Cyclogram c{.name = "day", .sections = {}};
  for (int k = 0; k < 16; ++k)
    c.sections.push_back({1800, {.speed_rpm = random.chance(0.25) ? 0.0 : random.uniform(500.0, 3000.0)}});
  return c;
}

/// As `validate` teaches one: its model is off by a tenth in each number, three runs of the machine with an indicator
/// that scatters by a micrometre teach it, and each of them left out in turn gives the interval.
DeployedPredictor taught() {
  constexpr double kIndicator_um = 1.0;
  std::vector<ObservedRun> training;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    training.push_back(run_of(three_parts(), 60.0, 0.0, kNoise_K, seed, day(seed)));
    Random random(seed, 99);
    for (double& um : training.back().readings.channels[3].values) um += kIndicator_um * random.normal();
  }
  const auto learned_from = [](std::span<const ObservedRun> runs) {
    Observer o(scattered(three_parts(), 0.1, 7), Eigen::Vector3d::Zero(), 0.0, {"T1", "T2", "T3"}, "drift_y",
               {.drift_um = kIndicator_um});
    o.learn(runs);
    return o.calibrated(runs);
  };
  DeployedPredictor d;
  d.name = "observer";
  d.target = "drift_y";
  d.from_start = true;
  d.predictor = std::make_shared<Observer>(learned_from(training));
  std::vector<Record> readings;
  std::vector<std::vector<double>> predicted;
  for (std::size_t r = 0; r < training.size(); ++r) {
    readings.push_back(training[r].readings);
    predicted.push_back(live(*d.predictor, training[r]));
    std::vector<ObservedRun> rest = training;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(r));
    std::vector<double> off_um = live(learned_from(rest), training[r]);
    for (std::size_t i = 0; i < off_um.size(); ++i)
      off_um[i] = std::abs(off_um[i] - training[r].readings.channels[3].values[i]);
    d.interval_um = std::max(d.interval_um.value_or(0.0), quantile(off_um, 0.95));
  }
  d.fail_safe = learn_fail_safe(readings, {}, predicted, true);
  return d;
}

struct Followed {
  int n = 0, n_faded = 0, n_calm_and_wrong = 0;
  double rms_left_um = 0.0, rms_before_um = 0.0;
  std::vector<std::string> doubted;
};
Followed follow(const DeployedPredictor& d, const ObservedRun& run) {
  DeployedFollower follower(d);
  Followed f;
  const std::vector<double>& drift_um = run.readings.at("drift_y").values;
  std::vector<double> left_um;
  ObservedRun so_far = run;
  so_far.readings.time_s.clear();
  for (Channel& c : so_far.readings.channels) c.values.clear();
  for (std::size_t i = 0; i < drift_um.size(); ++i) {
    so_far.readings.time_s.push_back(run.readings.time_s[i]);
    for (std::size_t c = 0; c < run.readings.channels.size(); ++c)
      so_far.readings.channels[c].values.push_back(run.readings.channels[c].values[i]);
    const FollowedCorrection now = follower.next(so_far);
    left_um.push_back(drift_um[i] - now.correction_um);
    ++f.n;
    f.n_faded += now.trust < 0.9;
    f.n_calm_and_wrong += now.trust > 0.95 && std::abs(left_um.back()) > 2.0 * now.interval_um.value_or(INFINITY);
    for (const std::string& name : follower.doubted()) f.doubted.push_back(name);
  }
  f.rms_left_um = score(left_um).rmse;
  f.rms_before_um = score(drift_um).rmse;
  return f;
}

// Each power and each film wrong by a factor of 1.3 to 3, either way, twelve of each: a second machine unknown to the observer.
TEST(ObserverTrust, FallsWhereTheModelIsWrongInOneNumber) {
  const DeployedPredictor d = taught();
  int n = 0, n_calm_and_wrong = 0;
  for (int wrong = 0; wrong < 48; ++wrong) {
    const double by = std::pow(1.3 + 1.7 * (wrong / 4 % 6) / 5.0, wrong / 24 == 0 ? 1.0 : -1.0);
    solver::ModelFactors factors{.source = {1.0, 1.0}, .exchange = {1.0, 1.0}};
    (wrong % 4 < 2 ? factors.source[static_cast<std::size_t>(wrong % 4)]
                   : factors.exchange[static_cast<std::size_t>(wrong % 4 - 2)]) = by;
    const auto seed = static_cast<std::uint64_t>(100 + wrong);
    const ObservedRun run = run_of(solver::with_factors(three_parts(), factors), 60.0, 0.0, kNoise_K, seed, day(seed));
    const Followed f = follow(d, run);
    n += f.n;
    n_calm_and_wrong += f.n_calm_and_wrong;
    EXPECT_LT(f.rms_left_um, 1.05 * f.rms_before_um) << wrong << " by " << by;
  }
  // 1.5 % when this was written; 21 % where a sensor is given up and the model never doubted. What is left are the first
  // minutes of heat, which no reading shows yet.
  EXPECT_LE(n_calm_and_wrong, n / 60) << n;
}

TEST(ObserverTrust, StaysWithTheMachineThatItKnows) {
  const DeployedPredictor d = taught();
  int n = 0, n_faded = 0;
  for (std::uint64_t seed = 200; seed < 220; ++seed) {
    const Followed f = follow(d, run_of(three_parts(), 60.0, 0.0, kNoise_K, seed, day(seed)));
    n += f.n;
    n_faded += f.n_faded;
    EXPECT_THAT(f.doubted, IsEmpty()) << seed;
  }
  EXPECT_LE(n_faded, n / 1000);
}

// One of three thermometers sticks: the others agree with the model, and it is the thermometer that is given up.
TEST(ObserverTrust, StaysWhereOneThermometerIsBroken) {
  ObservedRun run = run_of(three_parts(), 60.0, 0.0, kNoise_K, 300, day(300));
  std::vector<double>& t1 = run.readings.channels[0].values;
  std::fill(t1.begin() + 200, t1.end(), t1[199] + 4.0);
  const Followed f = follow(taught(), run);
  EXPECT_LT(f.rms_left_um, 0.1 * f.rms_before_um);
  EXPECT_LE(f.n_faded, f.n / 20);
  EXPECT_THAT(f.doubted, Contains(HasSubstr("T1")));
}

// The motor heats 2.5 times as much as the model says: all three disagree, none is given up, and the model is named.
TEST(ObserverTrust, BlamesTheModelBeforeSeveralGoodThermometers) {
  const ObservedRun run =
      run_of(solver::with_factors(three_parts(), {.source = {2.5, 1.0}}), 60.0, 0.0, kNoise_K, 301, day(301));
  const Followed f = follow(taught(), run);
  EXPECT_THAT(f.doubted, Contains(HasSubstr("the model")));
  EXPECT_LE(f.n_calm_and_wrong, 6);  // minutes
}

}  // namespace
}  // namespace driftwright::compensation::observer_trust_test
