// The watch of a running observer, on a machine of three lumped parts: alarms where nothing is wrong are as seldom as is
// stated, faults raise one.

#include "follow/watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "follow/watch_json.hpp"
#include "follow/watch_trial.hpp"
#include "tests/temporary_file.hpp"
#include "tests/three_parts.hpp"

namespace driftwright::follow::watch_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
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
Raised alarms(const TrialMachine& machine, const compensation::ObservedRun& run) {
  Watch watch(machine.observer(), limits());
  Raised raised;
  compensation::ObservedRun growing = run;
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
  const compensation::ObservedRun run = machine.work(0.3 * kDay_s, {}, 9002);
  Watch whole(machine.observer(), limits()), first(machine.observer(), limits());
  compensation::ObservedRun growing = run;
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
  EXPECT_THAT([&] { (void)read_watch(path, "two"); }, ThrowsMessage<InputError>(HasSubstr("another model file")));
}

TEST(Watch, LimitsThatAreNotAsTheyWereWrittenAreRefused) {
  output::Json json = watch_json(limits(), "one");
  const auto read = [](const output::Json& j) { (void)read_watch(write_file("changed.watch", j.dump(1)), "one"); };
  EXPECT_NO_THROW(read(json));  // the layout does not matter
  json["scales"][0]["threshold"] = 2.0 * json["scales"][0]["threshold"].get<double>();
  EXPECT_THAT([&] { read(json); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("changed.watch"), HasSubstr("damaged or changed"))));
  json.erase("hash");  // as versions before wrote them
  EXPECT_THAT([&] { read(json); }, ThrowsMessage<InputError>(HasSubstr("`follow --calibrate-watch` writes it anew")));
}

TEST(Watch, ThresholdsWantAMachineForADay) {
  EXPECT_THROW((void)simulated_limits(observer(), kSensors, kSettings, 0, 7.0, {}), std::logic_error);
  EXPECT_THROW((void)simulated_limits(observer(), kSensors, kSettings, 10, 0.5, {}), std::logic_error);
}

}  // namespace
}  // namespace driftwright::follow::watch_test
