// A deployed predictor row by row, on a run whose old rows are dropped, gives the same as on the whole run; and it
// continues from its memory.

#include "compensation/predictors/deployed_follower.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "compensation/predictors/formula_predictor.hpp"
#include "compensation/predictors/observer.hpp"
#include "compensation/predictors/past_drift.hpp"
#include "tests/shared/deployed_model.hpp"
#include "tests/shared/three_parts.hpp"

namespace driftwright::compensation::deployed_follower_test {
namespace {

/// The rows of a run one after another; those further back than followers look are dropped at each.
class Stream {
 public:
  explicit Stream(const MachineRun& whole) : whole_(whole) {
    run_.cyclogram.name = whole.cyclogram.name;
    run_.readings.source = whole.readings.source;
    run_.readings.channels = whole.readings.channels;
    for (Channel& c : run_.readings.channels) c.values.clear();
  }
  MachineRun& next() {
    Record& r = run_.readings;
    const std::size_t i = run_.n_forgotten + r.n_samples();
    const double t_s = whole_.readings.time_s[i];
    if (r.n_samples() > 0)
      run_.cyclogram.sections.push_back({t_s - r.time_s.back(), whole_.cyclogram.drive(r.time_s.back())});
    r.time_s.push_back(t_s);
    run_.ambient.time_s.push_back(t_s);
    run_.ambient.value.push_back(whole_.ambient.at(t_s));
    for (std::size_t c = 0; c < r.channels.size(); ++c)
      r.channels[c].values.push_back(whole_.readings.channels[c].values[i]);
    while (r.n_samples() > kRowsBack + 1) forget_first();
    return run_;
  }
  /// Keeps only the last row, as after a restart.
  void forget_all_but_last() {
    while (run_.readings.n_samples() > 1) forget_first();
  }

 private:
  void forget_first() {
    Record& r = run_.readings;
    const auto drop = [](auto& list) { list.erase(list.begin()); };
    drop(r.time_s);
    for (Channel& c : r.channels) drop(c.values);
    drop(run_.ambient.time_s);
    drop(run_.ambient.value);
    drop(run_.cyclogram.sections);
    run_.cyclogram_from_s = r.time_s.front();
    ++run_.n_forgotten;
  }
  const MachineRun& whole_;
  MachineRun run_;
};

DeployedPredictor formula(bool from_start) {
  output::DeployedModel model = fixtures::deployed(from_start, 60.0);
  DeployedPredictor d;
  d.target = "drift_y";
  d.from_start = from_start;
  d.fail_safe = std::move(model.safe);
  d.predictor = std::make_shared<FormulaPredictor>(std::move(model.model));
  return d;
}

DeployedPredictor observer(std::vector<std::string> sensors) {
  const ObserverSettings settings;
  Observer o(fixtures::three_parts(), Eigen::Vector3d::Zero(), 0.0, std::move(sensors), "drift_y", settings);
  DeployedPredictor d;
  d.target = "drift_y";
  d.from_start = true;
  d.fail_safe.emplace();
  d.fail_safe->lowest_um = -500.0;
  d.fail_safe->highest_um = 500.0;
  d.fail_safe->most_rate_um_s = 1.0;
  d.predictor = std::make_shared<Observer>(std::move(o));
  return d;
}

/// Follows a run row by row, with a restart after a row; no restart for a number beyond its rows.
std::vector<double> followed(const DeployedPredictor& d, const MachineRun& run, std::size_t restart_behind,
                             std::vector<double>* trust = nullptr, std::vector<double>* interval_um = nullptr) {
  Stream stream(run);
  auto follower = std::make_unique<DeployedFollower>(d);
  std::vector<double> corrections;
  for (std::size_t i = 0; i < run.readings.n_samples(); ++i) {
    const FollowedCorrection c = follower->next(stream.next());
    corrections.push_back(c.correction_um);
    if (trust) trust->push_back(c.trust);
    if (interval_um) interval_um->push_back(c.interval_um.value_or(NAN));
    if (i != restart_behind) continue;
    const std::vector<double> memory = follower->memory();
    follower = std::make_unique<DeployedFollower>(d);
    follower->recall(memory);
    stream.forget_all_but_last();
  }
  return corrections;
}

constexpr std::size_t kNever = static_cast<std::size_t>(-1);

MachineRun machine_with_faults() {
  MachineRun run{.cyclogram = {.name = "work", .sections = {{9e4, {.speed_rpm = 1500.0}}}},
                 .ambient = {{0.0, 9000.0}, {0.0, 1.5}},
                 .readings = fixtures::machine(7, 60.0)};
  std::vector<double>& x = run.readings.channels[1].values;
  for (std::size_t i = 120; i < 140; ++i) x[i] = NAN;   // a broken wire
  for (std::size_t i = 220; i < 300; ++i) x[i] += 9.0;  // a thermometer that has fallen off
  return run;
}

TEST(DeployedFollower, AFormulaIsToTheLastBitWhatItIsOfTheWholeRun) {
  const MachineRun run = machine_with_faults();
  for (const bool from_start : {false, true}) {
    const DeployedPredictor d = formula(from_start);
    const GuardedCorrection whole = correct(d, run);
    EXPECT_GT(whole.events.size(), 1u);
    std::vector<double> trust;
    EXPECT_EQ(followed(d, run, kNever, &trust), whole.correction_um);
    EXPECT_EQ(trust, whole.trust);
    for (const std::size_t restart : {0u, 1u, 125u, 231u})
      EXPECT_EQ(followed(d, run, restart), whole.correction_um) << restart;
  }
}

// The formula and two members at equal distances on both sides of it: their root mean square is that distance.
TEST(DeployedFollower, TheIntervalOfAMeanGrowsAsItsMembersDepart) {
  const MachineRun run{.cyclogram = {.name = "work", .sections = {{9e4, {.speed_rpm = 1500.0}}}},
                       .ambient = {{0.0, 9000.0}, {0.0, 1.5}},
                       .readings = fixtures::machine(7, 60.0)};
  DeployedPredictor d = formula(true);
  const DriftModel mean = *d.predictor->formula();
  std::vector<DriftModel> members = {mean, mean};
  members[0].terms[2].coefficient *= 1.3;
  members[1].terms[2].coefficient *= 0.7;
  const std::vector<double> of_mean = live(*d.predictor, run), of_member = live(FormulaPredictor(members[0]), run);
  d.predictor = std::make_shared<FormulaPredictor>(mean, members);
  d.interval_um = 0.5;
  EXPECT_EQ(live(*d.predictor, run), of_mean);
  const GuardedCorrection whole = correct(d, run);
  int n_grown = 0, n_narrow = 0;
  for (const std::size_t restart : {kNever, std::size_t{40}}) {
    std::vector<double> interval_um;
    (void)followed(d, run, restart, nullptr, &interval_um);
    for (std::size_t i = 0; i < of_mean.size(); ++i) {
      ASSERT_EQ(whole.trust[i], 1.0);
      const double apart_um = std::abs(of_member[i] - of_mean[i]), half_um = std::max(0.5, 1.96 * apart_um);
      (half_um > 0.5 ? n_grown : n_narrow) += 1;
      EXPECT_NEAR(whole.interval_um[i], half_um + std::abs(of_mean[i] - whole.correction_um[i]), 1e-9) << i;
      EXPECT_NEAR(interval_um[i], whole.interval_um[i], 1e-9) << i;
    }
  }
  EXPECT_GT(n_grown, 50);
  EXPECT_GT(n_narrow, 5);
}

// Of a blend whose weights move: what its members may send to the axis is the same row by row as of the whole run. They are
// as far on both sides of the mean as trust leaves, also while a thermometer is repaired; a blend without `member_residuals`
// gives none.
TEST(DeployedFollower, TheMembersOfABlendAreWhatTheyAreOfTheWholeRun) {
  const MachineRun run = machine_with_faults();
  DeployedPredictor d = fixtures::deployed_blend();
  const GuardedCorrection whole = correct(d, run);
  ASSERT_EQ(whole.members_um.size(), 2u);
  DeployedFollower follower(d);
  Stream stream(run);
  double most_um = 0.0;
  for (std::size_t i = 0; i < run.readings.n_samples(); ++i) {
    const FollowedCorrection c = follower.next(stream.next());
    ASSERT_EQ(c.members_um.size(), 2u);
    for (std::size_t m = 0; m < 2; ++m) ASSERT_EQ(c.members_um[m], whole.members_um[m][i]) << i << " " << m;
    ASSERT_NEAR(c.members_um[0] + c.members_um[1], 2.0 * c.correction_um, 1e-9) << i;
    ASSERT_NEAR(c.members_um[0] - c.correction_um, 0.4 * c.trust * c.prediction_um, 1e-9) << i;
    most_um = std::max(most_um, c.members_um[0] - c.members_um[1]);
  }
  EXPECT_GT(most_um, 1.0);
  d.member_residuals.clear();
  EXPECT_TRUE(correct(d, run).members_um.empty());
}

TEST(DeployedFollower, AnObserverIsWhatItIsOfTheWholeRun) {
  const MachineRun run = fixtures::run_of(fixtures::three_parts(), 60.0, 3.0, 0.05);
  const DeployedPredictor d = observer({"T1", "T3"});
  const GuardedCorrection whole = correct(d, run);
  for (const std::size_t restart : {kNever, std::size_t{0}, std::size_t{100}}) {
    const std::vector<double> rows = followed(d, run, restart);
    ASSERT_EQ(rows.size(), whole.correction_um.size());
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_NEAR(rows[i], whole.correction_um[i], 1e-9) << i;
  }
}

TEST(DeployedFollower, AnObserverGivesUpTheSameSensorAtTheSameTime) {
  MachineRun run = fixtures::run_of(fixtures::three_parts(), 60.0, 0.0, 0.05);
  for (std::size_t i = 100; i < run.readings.n_samples(); ++i) run.readings.channels[0].values[i] = 20.0;  // fallen off
  const DeployedPredictor d = observer({"T1", "T2", "T3"});
  const GuardedCorrection whole = correct(d, run);
  const std::vector<std::string> given_up = d.predictor->observer()->observe(run).distrusted;
  ASSERT_EQ(given_up.size(), 1u);
  for (const std::size_t restart : {kNever, std::size_t{180}}) {
    Stream stream(run);
    auto follower = std::make_unique<DeployedFollower>(d);
    for (std::size_t i = 0; i < run.readings.n_samples(); ++i) {
      EXPECT_NEAR(follower->next(stream.next()).correction_um, whole.correction_um[i], 1e-9) << i;
      if (i != restart) continue;
      const std::vector<double> memory = follower->memory();
      follower = std::make_unique<DeployedFollower>(d);
      follower->recall(memory);
      stream.forget_all_but_last();
    }
    EXPECT_EQ(follower->doubted(), given_up);
  }
}

TEST(DeployedFollower, TheMemoryOfAnotherIsRefused) {
  const MachineRun run = machine_with_faults();
  Stream stream(run);
  const DeployedPredictor d = formula(false);
  DeployedFollower follower(d);
  (void)follower.next(stream.next());
  std::vector<double> memory = follower.memory();
  memory.pop_back();
  EXPECT_THROW(follower.recall(memory), std::logic_error);
  EXPECT_THROW(follower.recall(std::vector<double>{1.0}), std::logic_error);
}

}  // namespace
}  // namespace driftwright::compensation::deployed_follower_test
