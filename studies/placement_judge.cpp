#include "studies/placement_judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/quantity.hpp"
#include "base/random.hpp"
#include "compensation/judging/model_scatter.hpp"
#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/modal_predictor.hpp"
#include "compensation/predictors/regression.hpp"

namespace driftwright::studies {
namespace {

using compensation::Observer;

constexpr int kObserverModes = 12;        // as in `validate`
constexpr double kLongestStep_s = 300.0;  // of the filter; equal to the time between rows

std::string name_of(int candidate) {
  return fmt::format("place_{}", candidate);
}

/// Drifts and temperatures relative to the first row, for regressions.
Record since_start(const MachineRun& run, const std::vector<std::string>& channels) {
  Record record = run.readings;
  for (const std::string& channel : channels) record = compensation::counted_from_start(std::move(record), channel);
  return record;
}

}  // namespace

PlacementJudge::PlacementJudge(const PlacementModel& model, const std::vector<MachineRun>& fitted,
                               const std::vector<MachineRun>& judged, std::vector<int> candidates,
                               const std::vector<double>& scatter, const std::vector<int>& seeds, double noise_K)
    : model_(model), candidates_(std::move(candidates)), noise_K_(noise_K) {
  solver::ReducedSystem seen = model.system;
  solver::Outputs& outputs = seen.outputs;
  const auto n = static_cast<Eigen::Index>(candidates_.size()), n_drifts = static_cast<Eigen::Index>(model.drifts.size());
  outputs = {{}, {}, Eigen::MatrixXd(seen.size(), n + n_drifts), Eigen::VectorXd(n + n_drifts)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const int candidate = candidates_[static_cast<std::size_t>(i)];
    outputs.name.push_back(name_of(candidate));
    outputs.unit.emplace_back("K");
    outputs.state.col(i) = model.rows.row(candidate).transpose();
    outputs.ambient[i] = model.ambient[candidate];
  }
  for (Eigen::Index d = 0; d < n_drifts; ++d) {
    const Eigen::Index of_model = model.drifts[static_cast<std::size_t>(d)];
    outputs.name.push_back(model.channels[static_cast<std::size_t>(d)]);
    outputs.unit.emplace_back("m");
    outputs.state.col(n + d) = model.system.outputs.state.col(of_model);
    outputs.ambient[n + d] = model.system.outputs.ambient[of_model];
  }
  const compensation::ModalPredictor modes = compensation::make_ritz_predictor(
      seen, model.start, kObserverModes, {.drive = {}, .ambient_K = model.start_ambient_K});
  compensation::ObserverSettings settings;
  settings.reading_K = std::max(1e-3, noise_K);
  settings.longest_step_s = kLongestStep_s;
  settings.period_s = kLongestStep_s;
  for (const std::string& channel : model.channels)
    observers_.emplace_back(modes.system, modes.start, model.start_ambient_K, std::vector<std::string>{}, channel, settings);
  machines_.resize(scatter.size() * seeds.size());
  parallel_for(machines_.size(), [&](std::size_t m) {
    Machine& machine = machines_[m];
    machine.system = compensation::scattered(model.system, scatter[m / seeds.size()], seeds[m % seeds.size()], true);
    std::uint64_t seed = 1000 * (m + 1);
    for (const MachineRun& run : fitted)
      machine.fitted.push_back(since_start(read(machine.system, run, ++seed), model.channels));
    for (const MachineRun& run : judged) machine.judged.push_back(read(machine.system, run, ++seed));
  });
}

MachineRun PlacementJudge::read(const solver::ReducedSystem& system, const MachineRun& run, std::uint64_t seed) const {
  const Eigen::MatrixXd states = states_of(model_, system, run);
  const Eigen::MatrixXd drift = studies::drift_um(model_, run, states);
  MachineRun observed{.cyclogram = run.cyclogram, .ambient = run.ambient, .readings = {}};
  Record& record = observed.readings;
  record.source = run.cyclogram.name;
  record.time_s = run.readings.time_s;
  const double zero_K = model_.system.reference_K - kZeroCelsius_K;
  for (int candidate : candidates_) {
    Random random(seed, static_cast<std::uint64_t>(candidate));
    Channel channel{.name = name_of(candidate), .unit = "degC", .values = {}};
    for (Eigen::Index i = 0; i < states.cols(); ++i) {
      const double ambient_K = run.ambient.at(record.time_s[static_cast<std::size_t>(i)]);
      channel.values.push_back(zero_K + model_.rows.row(candidate).dot(states.col(i)) +
                               model_.ambient[candidate] * ambient_K + noise_K_ * random.normal());
    }
    record.channels.push_back(std::move(channel));
  }
  for (std::size_t d = 0; d < model_.channels.size(); ++d) {
    const Eigen::VectorXd column = drift.col(static_cast<Eigen::Index>(d));
    record.channels.push_back({.name = model_.channels[d], .unit = "um", .values = {column.begin(), column.end()}});
  }
  return observed;
}

std::vector<std::string> PlacementJudge::names(const std::vector<int>& set) const {
  std::vector<std::string> all;
  for (int candidate : set) all.push_back(name_of(candidate));
  return all;
}

void PlacementJudge::add(Sum& sum, const Machine& machine, const std::vector<Record>& fitted, const std::vector<int>& set,
                         const std::vector<MachineRun>& learned) const {
  const std::vector<std::string> sensors = names(set);
  for (std::size_t d = 0; d < model_.channels.size(); ++d) {
    const std::string& channel = model_.channels[d];
    Observer observer = observers_[d].with_sensors(sensors);
    if (!learned.empty()) observer.learn(learned);
    std::optional<compensation::Regression> regression;
    if (!set.empty()) regression = compensation::fit_regression(fitted, sensors, channel);
    for (const MachineRun& run : machine.judged) {
      const std::vector<double>& truth = run.readings.at(channel).values;
      const std::vector<double> seen = observer.observe(run).drift_um;
      std::vector<double> told(truth.size(), 0.0);
      if (regression) told = regression->predict(since_start(run, {channel}));
      for (std::size_t i = 0; i < truth.size(); ++i) {
        sum.observer += (truth[i] - seen[i]) * (truth[i] - seen[i]);
        sum.regression += (truth[i] - told[i]) * (truth[i] - told[i]);
      }
      sum.n += static_cast<double>(truth.size());
    }
  }
}

std::vector<Residual> PlacementJudge::of(const std::vector<std::vector<int>>& sets) const {
  std::vector<Sum> sums(sets.size() * machines_.size());
  parallel_for(sums.size(), [&](std::size_t i) {
    const Machine& machine = machines_[i % machines_.size()];
    add(sums[i], machine, machine.fitted, sets[i / machines_.size()], {});
  });
  std::vector<Residual> all;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    Sum total;
    for (std::size_t m = 0; m < machines_.size(); ++m) {
      const Sum& sum = sums[s * machines_.size() + m];
      total = {total.observer + sum.observer, total.regression + sum.regression, total.n + sum.n};
    }
    all.push_back({std::sqrt(total.observer / total.n), std::sqrt(total.regression / total.n)});
  }
  return all;
}

Residual PlacementJudge::behind_test(const std::vector<int>& set, const MachineRun& test) const {
  Sum total;
  for (std::size_t m = 0; m < machines_.size(); ++m) {
    const MachineRun run = read(machines_[m].system, test, 7000 + m);
    add(total, machines_[m], {since_start(run, model_.channels)}, set, {run});
  }
  return {std::sqrt(total.observer / total.n), std::sqrt(total.regression / total.n)};
}

double PlacementJudge::drift_um() const {
  double sum = 0.0, n = 0.0;
  for (const Machine& machine : machines_) {
    for (const MachineRun& run : machine.judged) {
      for (const std::string& channel : model_.channels) {
        for (double um : run.readings.at(channel).values) sum += um * um;
        n += static_cast<double>(run.readings.n_samples());
      }
    }
  }
  return std::sqrt(sum / n);
}

}  // namespace driftwright::studies
