// How often a watch cries wolf, and how often it sees the wolf: on machines that its thresholds were not set on.
//
//   watch MODEL.json TOP_RPM [MACHINES DAYS CASES]
//
// MODEL.json is an observer of `validate`. Thresholds are simulated as `follow --calibrate-watch` does. Then MACHINES
// others (100) work for DAYS (16) with nothing wrong, and CASES faults (60) of five sorts begin in machines of their own
// at unknown hours. The correction is followed over the same faults: how often it is calm (trust above 0.95) and more than
// twice its interval off, and what it leaves.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <numeric>

#include "base/random.hpp"
#include "compensation/predictors/deployed_follower.hpp"
#include "compensation/predictors/score.hpp"
#include "follow/watch_trial.hpp"
#include "output/predictor_file.hpp"

namespace {

using namespace driftwright;
using follow::TrialFault, follow::TrialMachine;
using Kind = TrialFault::Kind;

constexpr double kDay_s = 86400.0, kMonth_days = 30.0;

/// Times at which alarms were raised.
std::vector<double> alarms(const TrialMachine& machine, const follow::WatchLimits& limits, const MachineRun& run,
                           double* highest) {
  follow::Watch watch(machine.observer(), limits);
  std::vector<double> raised;
  MachineRun growing{.cyclogram = run.cyclogram, .ambient = run.ambient, .readings = run.readings};
  growing.readings.time_s.clear();  // values beyond the last time are not looked at
  for (double t_s : run.readings.time_s) {
    growing.readings.time_s.push_back(t_s);
    const bool was_raised = watch.alarm().has_value();
    const double level = watch.next(growing);
    if (highest) *highest = std::max(*highest, level);
    if (watch.alarm() && !was_raised) raised.push_back(t_s);
  }
  return raised;
}

/// What a deployed observer of the machine does over a run.
struct Followed {
  int n_rows = 0, n_calm_and_wrong = 0, n_faded = 0;
  double rms_left_um = 0.0, rms_before_um = 0.0;
};
Followed followed(const compensation::DeployedPredictor& judged, const TrialMachine& machine, const MachineRun& run) {
  compensation::DeployedPredictor d = judged;
  d.predictor = std::make_shared<compensation::Observer>(machine.observer());
  compensation::DeployedFollower follower(d);
  MachineRun growing{.cyclogram = run.cyclogram, .ambient = run.ambient, .readings = run.readings};
  growing.readings.time_s.clear();
  const std::vector<double>& drift_um = run.readings.at(d.target).values;
  Followed f;
  std::vector<double> left_um;
  for (std::size_t i = 0; i < drift_um.size(); ++i) {
    growing.readings.time_s.push_back(run.readings.time_s[i]);
    const compensation::FollowedCorrection now = follower.next(growing);
    left_um.push_back(drift_um[i] - now.correction_um);
    ++f.n_rows;
    f.n_faded += now.trust < 0.9;
    f.n_calm_and_wrong += now.trust > 0.95 && std::abs(left_um.back()) > 2.0 * now.interval_um.value_or(INFINITY);
  }
  f.rms_left_um = compensation::score(left_um).rmse;
  f.rms_before_um = compensation::score(drift_um).rmse;
  return f;
}

/// 95 % interval of alarms a month: of machines drawn with replacement, since alarms of one machine are no independent ones.
std::pair<double, double> rate_interval(const std::vector<std::size_t>& alarms_of_machine, double days) {
  constexpr int kDraws = 10000;
  Random random(77, 10);
  std::vector<double> rates;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < alarms_of_machine.size(); ++i)
      sum += alarms_of_machine[static_cast<std::size_t>(random.below(static_cast<int>(alarms_of_machine.size())))];
    rates.push_back(kMonth_days * static_cast<double>(sum) / (days * static_cast<double>(alarms_of_machine.size())));
  }
  std::sort(rates.begin(), rates.end());
  return {rates[kDraws / 40], rates[kDraws - 1 - kDraws / 40]};
}

TrialFault drawn(Kind kind, const TrialMachine& machine, Random& random) {
  TrialFault fault{.kind = kind, .onset_s = 60.0 * std::round(60.0 * random.uniform(26.0, 60.0))};
  const solver::ReducedSystem& s = machine.system();
  const auto one_of = [&](std::size_t n) { return static_cast<std::size_t>(random.below(static_cast<int>(n))); };
  if (kind == Kind::kFilm) {
    fault.index = one_of(s.exchanges.size());
    fault.factor = random.chance(0.5) ? random.uniform(0.2, 0.5) : random.uniform(2.0, 4.0);
  } else if (kind == Kind::kFanStops) {
    fault.index = one_of(s.exchanges.size());
    fault.factor = random.uniform(0.05, 0.2);
  } else if (kind == Kind::kPreload) {
    fault.index = one_of(s.sources.size());
    fault.factor = random.uniform(1.5, 2.5);
  } else if (kind == Kind::kSensorFallsOff) {
    fault.index = one_of(machine.sensors().size());
  } else {
    fault.factor = random.uniform(1.3, 2.0);
  }
  return fault;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return fmt::print(stderr, "watch MODEL.json TOP_RPM [MACHINES DAYS CASES]\n"), 2;
  const auto number = [&](int i, double fallback) { return argc > i ? std::atof(argv[i]) : fallback; };
  const output::PredictorFile file = output::read_predictor(argv[1]);
  if (!file.predictor.predictor->observer()) return fmt::print(stderr, "{} holds no observer\n", argv[1]), 2;
  const compensation::Observer& observer = *file.predictor.predictor->observer();
  const follow::TrialSettings settings{.top_rpm = number(2, 0.0)};
  const int n_machines = static_cast<int>(number(3, 100)), n_cases = static_cast<int>(number(5, 60));
  const double days = number(4, 16);
  const std::vector<std::string> sensors = follow::watchable_sensors(observer, {});
  const follow::WatchLimits limits =
      follow::simulated_limits(observer, sensors, settings, follow::kTrialMachines, follow::kTrialDays, {});
  fmt::print("{} thermometers; thresholds", sensors.size());
  for (std::size_t j = 0; j < limits.scales.size(); ++j)
    fmt::print(" {:.1f} over {:.0f} min,", limits.scales[j].threshold, follow::kWatchedOver_s[j] / 60.0);
  fmt::print(" from {:.0f} machine-days\n", limits.machine_days);

  std::vector<std::size_t> false_alarms(static_cast<std::size_t>(n_machines));
  std::vector<double> highest(static_cast<std::size_t>(n_machines));
#pragma omp parallel for schedule(dynamic, 1)
  for (int m = 0; m < n_machines; ++m) {
    const auto i = static_cast<std::size_t>(m);
    const TrialMachine machine(observer, sensors, settings, 20000 + i);
    false_alarms[i] = alarms(machine, limits, machine.work(days * kDay_s, {}, 30000 + i), &highest[i]).size();
  }
  const auto [low, high] = rate_interval(false_alarms, days);
  const std::size_t n_false = std::accumulate(false_alarms.begin(), false_alarms.end(), std::size_t{0});
  const auto n_alarming = std::count_if(false_alarms.begin(), false_alarms.end(), [](std::size_t n) { return n > 0; });
  fmt::print(
      "nothing wrong: {} alarms of {} machines in {:.0f} machine-days, {:.2f} a month (95 %: {:.2f} to {:.2f}); highest "
      "level {:.2f}\n",
      n_false, n_alarming, n_machines * days, kMonth_days * static_cast<double>(n_false) / (n_machines * days), low, high,
      *std::max_element(highest.begin(), highest.end()));

  constexpr std::array<Kind, 5> kKinds = {Kind::kFilm, Kind::kFanStops, Kind::kPreload, Kind::kSensorFallsOff,
                                          Kind::kDoorOpens};
  struct Case {
    Kind kind;
    bool is_seen = false, was_early = false, is_drawn = false;
    double after_h = 0.0, tau_h = 0.0, nats = 0.0;
    Followed followed;
  };
  std::vector<Case> cases(static_cast<std::size_t>(n_cases));
#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < n_cases; ++c) {
    const auto i = static_cast<std::size_t>(c);
    Case& one = cases[i];
    one.kind = kKinds[i % kKinds.size()];
    const TrialMachine machine(observer, sensors, settings, 40000 + i);
    Random random(50000 + i, 9);
    for (int trial = 0; trial < 50 && !one.is_drawn; ++trial) {  // until one is worth 16 nats by three time constants
      const TrialFault fault = drawn(one.kind, machine, random);
      const double tau_s = machine.time_constant_s(fault), end_s = fault.onset_s + std::max(3.0 * tau_s, 1800.0);
      one.nats = machine.nats(end_s, fault, 60000 + i);
      if (one.nats < 16.0) continue;
      one.is_drawn = true;
      one.tau_h = tau_s / 3600.0;
      const MachineRun run = machine.work(end_s, fault, 60000 + i, true);
      one.followed = followed(file.predictor, machine, run);
      for (double t_s : alarms(machine, limits, run, nullptr)) {
        if (t_s < fault.onset_s) {
          one.was_early = true;
        } else if (!one.is_seen) {
          one.is_seen = true;
          one.after_h = (t_s - fault.onset_s) / 3600.0;
        }
      }
    }
  }
  std::map<std::string, std::array<int, 3>> of_kind;
  int n_seen = 0, n_drawn = 0, n_rows = 0, n_calm_and_wrong = 0, n_worse = 0;
  for (const Case& c : cases) {
    auto& [n, seen, early] = of_kind[follow::words(c.kind)];
    if (!c.is_drawn) continue;
    ++n;
    ++n_drawn;
    seen += c.is_seen;
    n_seen += c.is_seen;
    early += c.was_early;
    fmt::print("  {:<22} tau {:5.2f} h  {:8.0f} nats  {}; {:.1f} of {:.1f} um left, calm and wrong in {} of {} rows\n",
               follow::words(c.kind), c.tau_h, c.nats,
               c.is_seen ? fmt::format("seen after {:.2f} h", c.after_h) : "not seen", c.followed.rms_left_um,
               c.followed.rms_before_um, c.followed.n_calm_and_wrong, c.followed.n_rows);
    n_rows += c.followed.n_rows;
    n_calm_and_wrong += c.followed.n_calm_and_wrong;
    n_worse += c.followed.rms_left_um > 1.05 * c.followed.rms_before_um;
  }
  for (const auto& [kind, n] : of_kind)
    fmt::print("{:<24} {} of {} within 3 time constants, {} with an alarm before\n", kind, n[1], n[0], n[2]);
  fmt::print("all {} of {}\n", n_seen, n_drawn);
  fmt::print(
      "correction calm and more than twice its interval off: {} of {} rows ({:.2f} %); {} cases left worse than none\n",
      n_calm_and_wrong, n_rows, 100.0 * n_calm_and_wrong / std::max(1, n_rows), n_worse);
}
