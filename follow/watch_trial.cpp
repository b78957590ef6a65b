#include "follow/watch_trial.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "base/errors.hpp"
#include "base/quantity.hpp"
#include "base/random.hpp"
#include "compensation/judging/model_scatter.hpp"
#include "effects/reading_chain.hpp"
#include "solver/propagator.hpp"

namespace driftwright::follow {
namespace {

using compensation::Observer;

constexpr double kDay_s = 86400.0, kHour_s = 3600.0;
constexpr double kTestedFor_s = 4.0 * kHour_s;       // each heating and each cooling test
constexpr double kTestedSpeeds[] = {0.4, 0.7, 1.0};  // shares of the top speed
constexpr double kFallsFor_s = 120.0;                // time constant of a thermometer in air
constexpr double kDoor_K = -3.0;                     // change of the ambient by an open door
constexpr double kBlock_s = 1800.0;
constexpr double kAlarmsADay = 1.0 / 300.0;  // for one scale
constexpr double kTail = 0.1;                // upper share of daily maxima that the exponential tail is fitted to
constexpr int kMachinesOfCovariance = 30;    // for the covariance, besides those for the thresholds
constexpr double kRow_s = 300.0;             // of the simulation for deployed limits: half of the shortest mean
constexpr double kOfTraining = 2.0;          // least threshold, over what the training runs reach

/// Sections of work and rest, starting at 6 in the morning.
Cyclogram shop_days(double duration_s, double top_rpm, Random& random) {
  Cyclogram c{.name = "shop", .sections = {}};
  for (double t_s = 0.0; t_s < duration_s;) {
    const double hour = std::fmod(t_s / kHour_s, 24.0);  // hours since 6 in the morning
    const bool is_week_end = static_cast<int>(t_s / kDay_s) % 7 >= 5;
    const bool is_rest = hour >= 16.0 || is_week_end;
    double length_s = 60.0 * std::round(random.uniform(15.0, 120.0));
    if (is_rest) length_s = 60.0 * std::round((24.0 - hour) * 60.0);
    length_s = std::max(60.0, std::min(length_s, duration_s - t_s));
    const double rpm = is_rest || random.chance(0.25) ? 0.0 : top_rpm * 0.1 * (1 + random.below(10));
    c.sections.push_back({length_s, {.speed_rpm = rpm}});
    t_s += length_s;
  }
  return c;
}

/// Ambient minus the reference temperature [K], one knot an hour: a daily wave of 1 to 3 K (peak to peak) and a random
/// part of 0.3 K.
TimeSeries shop_ambient(double duration_s, double at_start_K, Random& random) {
  TimeSeries ambient;
  const double wave_K = 0.5 * random.uniform(1.0, 3.0);
  double wander_K = 0.0;
  for (double t_s = 0.0; t_s <= duration_s + kHour_s; t_s += kHour_s) {
    const double day = wave_K * std::sin(2.0 * std::numbers::pi * (t_s / kDay_s - 0.1));
    ambient.time_s.push_back(t_s);
    ambient.value.push_back(at_start_K + day - wave_K * std::sin(-0.2 * std::numbers::pi) + wander_K);
    wander_K = 0.9 * wander_K + 0.3 * std::sqrt(1.0 - 0.81) * random.normal();
  }
  return ambient;
}

solver::ReducedSystem broken(const solver::ReducedSystem& machine, const TrialFault& fault) {
  using Kind = TrialFault::Kind;
  if (fault.kind == Kind::kNone || fault.kind == Kind::kSensorFallsOff) return machine;
  solver::ModelFactors f;
  f.source.assign(machine.sources.size(), 1.0);
  f.exchange.assign(machine.exchanges.size(), 1.0);
  if (fault.kind == Kind::kPreload) f.source.at(fault.index) = fault.factor;
  if (fault.kind == Kind::kFilm || fault.kind == Kind::kFanStops) f.exchange.at(fault.index) = fault.factor;
  if (fault.kind == Kind::kDoorOpens) {
    for (std::size_t e = 0; e < f.exchange.size(); ++e)
      f.exchange[e] = machine.exchanges[e].reaches_ambient() ? fault.factor : 1.0;
  }
  return solver::with_factors(machine, f);
}

/// The level that the daily maxima exceed with a probability. Most of a large maximum comes from the machine (its numbers
/// are off in ways that an observer cannot learn) and recurs each day: the tail is that of squares of normally
/// distributed numbers, which is exponential. Its scale is the mean excess over the 90 % quantile.
double tail_level(std::vector<double> maxima, double probability) {
  std::sort(maxima.begin(), maxima.end());
  const auto n_below = static_cast<std::size_t>((1.0 - kTail) * static_cast<double>(maxima.size()));
  const double from = maxima.at(n_below == 0 ? 0 : n_below - 1), n_above = static_cast<double>(maxima.size() - n_below);
  double excess = 0.0;
  for (std::size_t i = n_below; i < maxima.size(); ++i) excess += (maxima[i] - from) / n_above;
  return from + excess * std::log(n_above / static_cast<double>(maxima.size()) / probability);
}

}  // namespace

const char* words(TrialFault::Kind kind) {
  switch (kind) {
    case TrialFault::Kind::kNone:
      return "nothing";
    case TrialFault::Kind::kFilm:
      return "film";
    case TrialFault::Kind::kFanStops:
      return "fan stops";
    case TrialFault::Kind::kPreload:
      return "preload";
    case TrialFault::Kind::kSensorFallsOff:
      return "thermometer falls off";
    case TrialFault::Kind::kDoorOpens:
      return "open door";
  }
  throw std::logic_error("a fault of no kind");
}

TrialMachine::TrialMachine(const Observer& model, std::vector<std::string> sensors, const TrialSettings& settings,
                           std::uint64_t seed)
    : model_(model.state()),
      sensors_(std::move(sensors)),
      settings_(settings),
      machine_(compensation::scattered(model_.system, settings.scatter, static_cast<int>(seed), true)),
      observer_(model_.system, model_.start, model_.start_ambient_K, sensors_, model_.drift, model_.settings) {
  const std::vector<std::string>& outputs = machine_.outputs.name;
  for (const std::string& name : sensors_)
    output_.push_back(std::find(outputs.begin(), outputs.end(), name) - outputs.begin());
  std::vector<MachineRun> tests;
  for (const double share : kTestedSpeeds) {
    const Cyclogram test{.name = "test",
                         .sections = {{kTestedFor_s, {.speed_rpm = share * settings.top_rpm}}, {kTestedFor_s, {}}}};
    tests.push_back(read(test, {{0.0}, {model_.start_ambient_K}}, {}, 100 * seed + tests.size(), true));
  }
  observer_.learn(tests);
  observer_ = observer_.calibrated(tests);
}

Eigen::MatrixXd TrialMachine::readings_K(const Cyclogram& cyclogram, const TimeSeries& ambient,
                                         const std::vector<double>& time_s, const TrialFault& fault) const {
  const Eigen::VectorXd start = model_.start + (ambient.at(0.0) - model_.start_ambient_K) * machine_.ones;
  const bool has_fault = fault.kind != TrialFault::Kind::kNone;
  std::vector<double> before, behind;
  for (double t_s : time_s) (has_fault && t_s >= fault.onset_s ? behind : before).push_back(t_s);
  if (behind.empty()) return solver::Propagator(machine_).run(cyclogram, ambient, before, start).outputs;
  Eigen::MatrixXd states,
      y(static_cast<Eigen::Index>(machine_.outputs.name.size()), static_cast<Eigen::Index>(time_s.size()));
  std::vector<double> until = before;
  until.push_back(fault.onset_s);
  if (before.back() >= fault.onset_s) until.pop_back();
  const auto n_before = static_cast<Eigen::Index>(before.size()), n_behind = static_cast<Eigen::Index>(behind.size());
  y.leftCols(n_before) =
      solver::Propagator(machine_).run(cyclogram, ambient, until, start, false, &states).outputs.leftCols(n_before);
  const solver::ReducedSystem now = broken(machine_, fault);
  TimeSeries air = ambient;
  if (fault.kind == TrialFault::Kind::kDoorOpens) {
    for (double& v : air.value) v += kDoor_K;
  }
  const Eigen::VectorXd at_onset = states.rightCols<1>();
  y.rightCols(n_behind) =
      solver::Propagator(now).run(cyclogram, air, behind, at_onset, false, nullptr, fault.onset_s).outputs;
  if (fault.kind == TrialFault::Kind::kSensorFallsOff) {
    const Eigen::Index k = output_.at(fault.index);
    for (Eigen::Index i = n_before; i < y.cols(); ++i) {
      const double t_s = time_s[static_cast<std::size_t>(i)], h = ambient.at(t_s);
      y(k, i) = h + (y(k, n_before - 1) - h) * std::exp(-(t_s - fault.onset_s) / kFallsFor_s);
    }
  }
  return y;
}

MachineRun TrialMachine::read(const Cyclogram& cyclogram, const TimeSeries& ambient, const TrialFault& fault,
                              std::uint64_t seed, bool with_drift) const {
  MachineRun run{.cyclogram = cyclogram, .ambient = {}, .readings = {.source = "trial", .time_s = {}, .channels = {}}};
  std::vector<double>& t = run.readings.time_s;
  for (double t_s = 0.0; t_s <= cyclogram.duration_s(); t_s += settings_.period_s) t.push_back(t_s);
  const Eigen::MatrixXd y = readings_K(cyclogram, ambient, t, fault);
  Random random(seed, 7);
  for (double t_s : t) {
    run.ambient.time_s.push_back(t_s);
    run.ambient.value.push_back(ambient.at(t_s) + model_.settings.reading_K * random.normal());
  }
  for (std::size_t k = 0; k < sensors_.size(); ++k) {
    run.readings.channels.push_back({sensors_[k], "degC", {}});
    for (Eigen::Index i = 0; i < y.cols(); ++i)
      run.readings.channels.back().values.push_back(y(output_[k], i) + machine_.reference_K - kZeroCelsius_K +
                                                    model_.settings.reading_K * random.normal());
  }
  if (with_drift) {
    const auto& names = machine_.outputs.name;
    const Eigen::Index d = std::find(names.begin(), names.end(), model_.drift) - names.begin();
    run.readings.channels.push_back({model_.drift, "um", {}});
    for (Eigen::Index i = 0; i < y.cols(); ++i)
      run.readings.channels.back().values.push_back(1e6 * (y(d, i) - y(d, 0)) + model_.settings.drift_um * random.normal());
  }
  return run;
}

MachineRun TrialMachine::work(double duration_s, const TrialFault& fault, std::uint64_t seed, bool with_drift) const {
  Random random(seed, 8);
  const Cyclogram days = shop_days(duration_s, settings_.top_rpm, random);
  return read(days, shop_ambient(duration_s, model_.start_ambient_K, random), fault, seed, with_drift);
}

double TrialMachine::nats(double duration_s, const TrialFault& fault, std::uint64_t seed) const {
  Random random(seed, 8);
  const Cyclogram days = shop_days(duration_s, settings_.top_rpm, random);
  const TimeSeries ambient = shop_ambient(duration_s, model_.start_ambient_K, random);
  std::vector<double> t;
  for (double t_s = 0.0; t_s <= days.duration_s(); t_s += settings_.period_s) t.push_back(t_s);
  const Eigen::MatrixXd made = readings_K(days, ambient, t, fault) - readings_K(days, ambient, t, {});
  const double rows = kBlock_s / settings_.period_s;
  const double variance = std::pow(model_.settings.model_K, 2) + std::pow(model_.settings.reading_K, 2) / rows;
  double sum = 0.0;
  for (const Eigen::Index k : output_) sum += made.row(k).squaredNorm() / rows;
  return 0.5 * sum / variance;
}

double TrialMachine::time_constant_s(const TrialFault& fault) const {
  using Kind = TrialFault::Kind;
  const effects::Inputs at{.drive = {.speed_rpm = 0.5 * settings_.top_rpm}, .ambient_K = model_.start_ambient_K};
  Eigen::MatrixXd k = machine_.conduction;
  for (const auto& e : machine_.exchanges) k += e.coefficient(at) * e.matrix;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(machine_.size());
  if (fault.kind == Kind::kPreload) b = machine_.sources.at(fault.index).load;
  if (fault.kind == Kind::kFilm || fault.kind == Kind::kFanStops) b = machine_.exchanges.at(fault.index).flow;
  if (fault.kind == Kind::kSensorFallsOff) b = machine_.outputs.state.col(output_.at(fault.index));
  if (fault.kind == Kind::kDoorOpens) {
    for (const auto& e : machine_.exchanges) {
      if (e.reaches_ambient()) b += e.coefficient(at) * e.to_ambient;
    }
  }
  const Eigen::VectorXd x = k.ldlt().solve(b);
  return x.squaredNorm() / b.dot(x);
}

std::vector<std::string> watchable_sensors(const Observer& observer, const std::vector<Channel>& channels) {
  const Observer::State s = observer.state();
  std::vector<std::string> names;
  for (std::size_t o = 0; o < s.system.outputs.name.size(); ++o) {
    const auto j = static_cast<Eigen::Index>(o);
    if (s.system.outputs.unit[o] != "K" || !(s.system.outputs.state.col(j).norm() > 0.0)) continue;
    const std::string& name = s.system.outputs.name[o];
    const bool is_there = channels.empty() || std::any_of(channels.begin(), channels.end(), [&](const Channel& c) {
                            return c.name == name && c.unit == "degC";
                          });
    if (is_there && !effects::is_mean_output(name)) names.push_back(name);
  }
  return names;
}

namespace {

using OfScales = std::array<Eigen::MatrixXd, kWatchedOver_s.size()>;

/// Runs a healthy machine and passes on the means of its residuals, row by row.
/// @param take  called with the row's number and the means
template <class Take>
void follow_at_work(const Observer& model, const std::vector<std::string>& sensors, const TrialSettings& settings, int seed,
                    double days, Take take) {
  const TrialMachine trial(model, sensors, settings, 1000 + static_cast<std::uint64_t>(seed));
  const MachineRun run = trial.work(days * kDay_s, {}, 5000 + static_cast<std::uint64_t>(seed));
  const std::unique_ptr<compensation::ObserverFollower> follower = trial.observer().watch();
  ResidualMeans means(sensors.size());
  const std::vector<double>& t = run.readings.time_s;
  for (std::size_t i = 0; i < t.size(); ++i) {
    (void)follower->next(run);
    means.take(follower->innovation_K(), i > 0 ? t[i] - t[i - 1] : 0.0);
    take(i, means);
  }
}

}  // namespace

WatchLimits simulated_limits(const Observer& model, const std::vector<std::string>& sensors, const TrialSettings& settings,
                             int n_machines, double days_each, const Listener& listener) {
  const auto n = static_cast<Eigen::Index>(sensors.size());
  const auto n_days = static_cast<std::size_t>(days_each);
  if (n_machines < 1 || n_days < 1) throw std::logic_error("thresholds of a watch require a machine for a day");
  WatchLimits limits{.sensors = sensors, .scales = {}, .machine_days = static_cast<double>(n_days) * n_machines};
  listener.begin(fmt::format("simulating {} machines for {} days", n_machines + kMachinesOfCovariance, n_days));
  int n_done = 0;
  const auto told = [&] {
#pragma omp critical(told_of_trials)
    listener.share(static_cast<double>(++n_done) / (n_machines + kMachinesOfCovariance));
  };

  // The covariance comes from machines of its own, so that the machines whose T² gives the thresholds have no part in it.
  std::vector<OfScales> squares(kMachinesOfCovariance);
#pragma omp parallel for schedule(dynamic, 1)
  for (int m = 0; m < kMachinesOfCovariance; ++m) {
    OfScales& of_machine = squares[static_cast<std::size_t>(m)];
    of_machine.fill(Eigen::MatrixXd::Zero(n, n));
    double rows = 0.0;
    follow_at_work(model, sensors, settings, 100000 + m, days_each, [&](std::size_t, const ResidualMeans& means) {
      for (std::size_t j = 0; j < kWatchedOver_s.size(); ++j) of_machine[j] += means.mean(j) * means.mean(j).transpose();
      rows += 1.0;
    });
    for (Eigen::MatrixXd& c : of_machine) c /= rows;
    told();
  }
  OfScales inverse;
  for (std::size_t j = 0; j < kWatchedOver_s.size(); ++j) {
    limits.scales[j].covariance = Eigen::MatrixXd::Zero(n, n);
    for (const auto& of_machine : squares) limits.scales[j].covariance += of_machine[j] / kMachinesOfCovariance;
    inverse[j] = inverse_of(limits.scales[j].covariance);
  }

  const auto rows_a_day = static_cast<std::size_t>(kDay_s / settings.period_s);
  std::array<std::vector<double>, kWatchedOver_s.size()> maxima;
  for (std::vector<double>& of_scale : maxima) of_scale.assign(n_days * static_cast<std::size_t>(n_machines), 0.0);
#pragma omp parallel for schedule(dynamic, 1)
  for (int m = 0; m < n_machines; ++m) {
    follow_at_work(model, sensors, settings, m, days_each, [&](std::size_t row, const ResidualMeans& means) {
      const std::size_t day = row / rows_a_day;
      if (day >= n_days) return;
      for (std::size_t j = 0; j < kWatchedOver_s.size(); ++j) {
        double& most = maxima[j][static_cast<std::size_t>(m) * n_days + day];
        most = std::max(most, size_of(inverse[j], means.mean(j)));
      }
    });
    told();
  }
  for (std::size_t j = 0; j < kWatchedOver_s.size(); ++j) {
    double& threshold = limits.scales[j].threshold = tail_level(maxima[j], kAlarmsADay);
    limits.n_alarms +=
        static_cast<int>(std::count_if(maxima[j].begin(), maxima[j].end(), [&](double x) { return x > threshold; }));
  }
  return limits;
}

namespace {

/// An observer whose readings are means of all rows within `row_s`: less noise, and longer steps of its filter.
Observer of_longer_rows(const Observer& observer, double row_s) {
  Observer::State s = observer.state();
  if (s.settings.period_s >= row_s) return observer;
  s.settings.reading_K *= std::sqrt(s.settings.period_s / row_s);
  s.settings.drift_um *= std::sqrt(s.settings.period_s / row_s);
  s.settings.longest_step_s = std::max(s.settings.longest_step_s, row_s);
  return Observer::of_state(std::move(s));
}

double top_rpm(std::span<const MachineRun> runs) {
  double rpm = 0.0;
  for (const MachineRun& run : runs) {
    for (const auto& section : run.cyclogram.sections) rpm = std::max(rpm, section.drive.speed_rpm);
  }
  return rpm;
}

/// Largest T² of a scale in the rows of a run.
std::array<double, kWatchedOver_s.size()> largest_in(const MachineRun& run, const Observer& observer,
                                                     const WatchLimits& limits) {
  std::array<double, kWatchedOver_s.size()> most{};
  OfScales inverse;
  for (std::size_t j = 0; j < most.size(); ++j) inverse[j] = inverse_of(limits.scales[j].covariance);
  const std::unique_ptr<compensation::ObserverFollower> follower = observer.watch();
  ResidualMeans means(limits.sensors.size());
  const std::vector<double>& t = run.readings.time_s;
  for (std::size_t i = 0; i < t.size(); ++i) {
    (void)follower->next(run);
    means.take(follower->innovation_K(), i > 0 ? t[i] - t[i - 1] : 0.0);
    for (std::size_t j = 0; j < most.size(); ++j) most[j] = std::max(most[j], size_of(inverse[j], means.mean(j)));
  }
  return most;
}

}  // namespace

std::optional<WatchLimits> deployed_limits(const Observer& observer, std::span<const MachineRun> training,
                                           const Listener& listener) {
  const TrialSettings settings{.top_rpm = top_rpm(training),
                               .period_s = std::max(kRow_s, observer.state().settings.period_s)};
  if (observer.sensors().empty() || !(settings.top_rpm > 0.0)) return std::nullopt;
  WatchLimits limits = simulated_limits(of_longer_rows(observer, settings.period_s), observer.sensors(), settings,
                                        kTrialMachines, kTrialDays, listener);
  for (const MachineRun& run : training) {
    const auto most = largest_in(run, observer, limits);
    for (std::size_t j = 0; j < most.size(); ++j)
      limits.scales[j].threshold = std::max(limits.scales[j].threshold, kOfTraining * most[j]);
  }
  return limits;
}

}  // namespace driftwright::follow
