// The watch of a running observer, on a machine of three lumped parts: alarms where nothing is wrong are as seldom as is
// stated, faults raise one.

#include "follow/watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "follow/watch_json.hpp"
#include "follow/watch_trial.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"
#include "tests/shared/three_parts.hpp"

namespace driftwright::follow::watch_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::ThrowsMessage;
using Kind = TrialFault::Kind;

constexpr double kDay_s = 86400.0;

const compensation::Observer& observer() {
  static const compensation::Observer o(fixtures::three_parts(), Eigen::Vector3d::Zero(), 0.0, {"T1", "T2", "T3"},
                                        "drift_y");
  return o;
}
const std::vector<std::string> kSensors = {"T1", "T2", "T3"};
constexpr TrialSettings kSettings{.top_rpm = 3000.0};

const WatchLimits& limits() {
  static const WatchLimits l = simulated_limits(observer(), kSensors, kSettings, kTrialMachines, kTrialDays, {});
  return l;
}

/// Times at which alarms were raised, and the words of the last one.
struct Raised {
  std::vector<double> time_s;
  std::string words;
};
Raised alarms(const TrialMachine& machine, const MachineRun& run, const WatchLimits& of = limits()) {
  Watch watch(machine.observer(), of);
  Raised raised;
  MachineRun growing = run;
  growing.readings.time_s.clear();  // values beyond the last time are not looked at
  for (double t_s : run.readings.time_s) {
    growing.readings.time_s.push_back(t_s);
    const bool was_raised = watch.alarm().has_value();
    (void)watch.next(growing);
    if (!watch.alarm() || was_raised) continue;
    raised.time_s.push_back(t_s);
    raised.words = watch.alarm()->words;
  }
  return raised;
}

// Stated: one of 300 days for each of three scales, 7 alarms of 700 days. Those of one machine come together, so twice as
// many are let pass. There are 9; with thresholds of ten machines, as they were, 22.
TEST(Watch, RaisesNoMoreAlarmsOnOtherMachinesThanItStates) {
  EXPECT_EQ(limits().machine_days, 700.0);
  std::size_t n = 0;
  for (int m = 0; m < 100; ++m) {
    const TrialMachine machine(observer(), kSensors, kSettings, 7000 + static_cast<std::uint64_t>(m));
    n += alarms(machine, machine.work(7.0 * kDay_s, {}, 8000 + static_cast<std::uint64_t>(m))).time_s.size();
  }
  EXPECT_LE(n, 14U);
}

TEST(Watch, SeesAFanThatStopsAPreloadAndAThermometerThatFallsOffAndSaysWhichThermometersShowIt) {
  const TrialMachine machine(observer(), kSensors, kSettings, 9000);
  const double onset_s = kDay_s + 4.0 * 3600.0;
  for (const TrialFault& fault : {TrialFault{Kind::kFanStops, onset_s, 1, 0.1}, TrialFault{Kind::kPreload, onset_s, 0, 2.5},
                                  TrialFault{Kind::kSensorFallsOff, onset_s, 2, 1.0}}) {
    const double end_s = onset_s + std::max(3600.0, 3.0 * machine.time_constant_s(fault));
    ASSERT_GT(machine.nats(end_s, fault, 9001), 16.0) << words(fault.kind);
    const Raised raised = alarms(machine, machine.work(end_s, fault, 9001));
    ASSERT_EQ(raised.time_s.size(), 1U) << words(fault.kind);
    EXPECT_GT(raised.time_s.front(), onset_s) << words(fault.kind);
    if (fault.kind == Kind::kSensorFallsOff) {
      EXPECT_THAT(raised.words, HasSubstr("T3 is "));
    }
  }
}

TEST(Watch, GoesOnFromItsMemoryAsWithoutARestart) {
  const TrialMachine machine(observer(), kSensors, kSettings, 9000);
  const MachineRun run = machine.work(0.3 * kDay_s, {}, 9002);
  Watch whole(machine.observer(), limits()), first(machine.observer(), limits());
  MachineRun growing = run;
  growing.readings.time_s.clear();
  std::unique_ptr<Watch> second;
  for (std::size_t i = 0; i < run.readings.time_s.size(); ++i) {
    growing.readings.time_s.push_back(run.readings.time_s[i]);
    const double level = whole.next(growing);
    if (i == 200) {
      second = std::make_unique<Watch>(machine.observer(), limits());
      second->recall(first.memory());
    }
    EXPECT_EQ(second ? second->next(growing) : first.next(growing), level) << i;
  }
}

TEST(Watch, LimitsAreReadAsTheyWereWrittenAndNotForAnotherModel) {
  const std::string path = write_file("limits.watch", watch_json(limits(), "one").dump());
  const WatchLimits read = read_watch(path, "one");
  EXPECT_EQ(read.sensors, limits().sensors);
  for (std::size_t j = 0; j < kWatchedOver_s.size(); ++j) {
    EXPECT_EQ(read.scales[j].threshold, limits().scales[j].threshold);
    EXPECT_EQ(read.scales[j].covariance, limits().scales[j].covariance);
  }
  EXPECT_REFUSED(read_watch(path, "two"), "another model file");
}

TEST(Watch, LimitsThatAreNotAsTheyWereWrittenAreRefused) {
  output::Json json = watch_json(limits(), "one");
  const auto read = [](const output::Json& j) { (void)read_watch(write_file("changed.watch", j.dump(1)), "one"); };
  EXPECT_NO_THROW(read(json));  // the layout does not matter
  json["scales"][0]["threshold"] = 2.0 * json["scales"][0]["threshold"].get<double>();
  EXPECT_THAT([&] { read(json); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("changed.watch"), HasSubstr("damaged or changed"))));
  json.erase("hash");  // as versions before wrote them
  EXPECT_REFUSED(read(json), "`follow --calibrate-watch` writes it anew");
}

TEST(Watch, ThresholdsWantAMachineForADay) {
  EXPECT_THROW((void)simulated_limits(observer(), kSensors, kSettings, 0, 7.0, {}), std::logic_error);
  EXPECT_THROW((void)simulated_limits(observer(), kSensors, kSettings, 10, 0.5, {}), std::logic_error);
}

// Three runs of a sound machine, taught as `validate` does.
compensation::Observer taught_by(const solver::ReducedSystem& machine) {
  std::vector<MachineRun> runs;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) runs.push_back(fixtures::run_of(machine, 60.0, 0.0, 0.1, seed));
  compensation::Observer o = observer();
  o.learn(runs);
  return o;
}

// Simulated at rows of 5 min, used at rows of 1 min: alarms are as seldom as with limits of rows of 1 min.
TEST(Watch, DeployedLimitsRaiseNoMoreAlarmsAtShorterRows) {
  const MachineRun training = fixtures::run_of(fixtures::three_parts(), 60.0, 0.0, 0.1);
  const std::optional<WatchLimits> deployed = deployed_limits(taught_by(fixtures::three_parts()), {&training, 1}, {});
  ASSERT_TRUE(deployed);
  EXPECT_EQ(deployed->sensors, kSensors);
  std::size_t n = 0;
  for (int m = 0; m < 100; ++m) {
    const TrialMachine machine(observer(), kSensors, kSettings, 7000 + static_cast<std::uint64_t>(m));
    n += alarms(machine, machine.work(7.0 * kDay_s, {}, 8000 + static_cast<std::uint64_t>(m)), *deployed).time_s.size();
  }
  EXPECT_LE(n, 14U);
}

// A model that was off in training raises no alarm at being as far off: its verdict says how good it is.
TEST(Watch, DeployedLimitsAllowTwiceWhatTheTrainingReached) {
  solver::ModelFactors factors{.source = {2.5, 1.0}, .exchange = {1.0, 1.0}};
  const MachineRun off = fixtures::run_of(solver::with_factors(fixtures::three_parts(), factors), 60.0, 0.0, 0.1);
  const compensation::Observer model = observer();  // has learned nothing of it
  const auto sound = fixtures::run_of(fixtures::three_parts(), 60.0, 0.0, 0.1);
  const WatchLimits narrow = *deployed_limits(model, {&sound, 1}, {}), wide = *deployed_limits(model, {&off, 1}, {});
  const auto is_raised = [&](const WatchLimits& limits) {
    Watch watch(model, limits);
    bool is = false;
    MachineRun growing = off;
    growing.readings.time_s.clear();
    for (double t_s : off.readings.time_s) {
      growing.readings.time_s.push_back(t_s);
      is = is || watch.next(growing) > 1.0;
    }
    return is;
  };
  EXPECT_TRUE(is_raised(narrow));
  EXPECT_FALSE(is_raised(wide));
}

TEST(Watch, NoLimitsWithoutAThermometerOrASpeed) {
  const auto run = fixtures::run_of(fixtures::three_parts());
  const auto at_rest =
      fixtures::run_of(fixtures::three_parts(), 60.0, 0.0, 0.0, 1, {.name = "rest", .sections = {{3600, {}}}});
  EXPECT_FALSE(deployed_limits(observer().with_sensors({}), {&run, 1}, {}));
  EXPECT_FALSE(deployed_limits(observer(), {&at_rest, 1}, {}));
}

// The alarm says what its thermometers show now, also after a restart, and not what they showed when it was raised.
TEST(Watch, AnAlarmSaysWhatHoldsNow) {
  MachineRun run = fixtures::run_of(fixtures::three_parts(), 60.0, 0.0, 0.1);
  std::vector<double>& t3 = run.readings.channels[2].values;
  for (std::size_t i = 60; i < t3.size(); ++i) t3[i] += i < 120 ? 6.0 : -6.0;
  Watch watch(observer(), limits());
  std::vector<std::string> words;
  MachineRun growing = run;
  growing.readings.time_s.clear();
  for (std::size_t i = 0; i < t3.size(); ++i) {
    growing.readings.time_s.push_back(run.readings.time_s[i]);
    (void)watch.next(growing);
    words.push_back(watch.alarm() ? watch.alarm()->words : "");
  }
  EXPECT_EQ(words[59], "");
  EXPECT_THAT(words[110], AllOf(HasSubstr("T3 is "), HasSubstr("K warmer")));
  EXPECT_THAT(words[200], AllOf(HasSubstr("T3 is "), HasSubstr("K colder")));
  Watch again(observer(), limits());
  again.recall(watch.memory());
  ASSERT_TRUE(again.alarm());
  EXPECT_EQ(again.alarm()->since_s, watch.alarm()->since_s);
  EXPECT_THAT(again.alarm()->words, AllOf(HasSubstr("T3 is "), HasSubstr("K colder")));  // of the means, until the next row
}

}  // namespace
}  // namespace driftwright::follow::watch_test
