#pragma once
// A formula with every kind of term and its fail-safe, and records of its machine.

#include <algorithm>
#include <cmath>

#include "compensation/predictors/formula_predictor.hpp"
#include "output/drift_model_files.hpp"
#include "tests/shared/sensor_records.hpp"

namespace driftwright::fixtures {

using compensation::DriftModel;
using compensation::FailSafe;
using output::DeployedModel;

/// Four correlated thermometers and a speed; one row per `period_s`.
inline Record machine(std::uint64_t seed, double period_s) {
  Record r = sensor_record(seed, 300, 4, 0.02, 0.1);
  for (std::size_t i = 0; i < r.n_samples(); ++i) {
    r.channels[2].values[i] =
        0.5 * (r.channels[0].values[i] + r.channels[1].values[i]) + 0.01 * std::sin(5.0 * static_cast<double>(i));
    r.channels[3].values[i] = r.channels[0].values[i] + 0.01 * std::cos(7.0 * static_cast<double>(i));
    r.time_s[i] = 100.0 + period_s * static_cast<double>(i);
  }
  Random random(seed, 2);
  double speed = 0.0;
  r.channels.push_back({"spindle", "rpm", {}});
  for (std::size_t i = 0; i < r.n_samples(); ++i) {
    if (random.chance(0.05)) speed = std::max(0.0, 4000.0 * random.uniform() - 1000.0);  // sometimes at rest
    r.channels.back().values.push_back(speed);
  }
  return r;
}

/// The same machine just after work: X1, and what follows it, is warm.
inline Record warm_machine(std::uint64_t seed, double period_s) {
  Record r = machine(seed, period_s);
  for (std::size_t i = 0; i < r.n_samples(); ++i) {
    const double warmer_K = 5.0 * std::exp(-0.05 * static_cast<double>(i));
    r.channels[0].values[i] += warmer_K;
    r.channels[2].values[i] += 0.5 * warmer_K;
    r.channels[3].values[i] += warmer_K;
  }
  return r;
}

inline DeployedModel deployed(bool from_start, double period_s) {
  DeployedModel d;
  d.model = {.kind = "regression with lags",
             .target = "drift_y",
             .target_unit = "um",
             .intercept = 1.0 / 3.0,
             .terms = {{.input = "X3", .unit = "degC", .coefficient = -0.7},  // not in the order of the guards
                       {.input = "X1", .unit = "degC", .coefficient = 1.1},
                       {.input = "X1", .unit = "degC", .coefficient = 2.3, .lag_s = 13.0 * period_s},
                       {.input = "X2", .unit = "degC", .coefficient = 0.02, .power = 2},
                       {.input = "X2", .unit = "degC", .coefficient = 0.01, .power = 2, .lag_s = 31.0 * period_s},
                       {.input = "X4", .unit = "degC", .coefficient = 0.9},
                       {.input = "spindle", .unit = "rpm", .coefficient = 1e-6, .power = 2, .lag_s = 20.0 * period_s},
                       {.input = "spindle", .unit = "rpm", .coefficient = 2e-4},
                       {.input = "spindle", .unit = "rpm", .coefficient = 3.0, .lag_s = 9.0 * period_s, .is_running = true},
                       {.input = "spindle", .unit = "rpm", .coefficient = 0.4, .is_running = true}},
             .from_start = from_start};
  const std::vector<Record> training = {machine(1, period_s), machine(2, period_s)};
  std::vector<std::vector<double>> predicted;
  for (const Record& r : training) predicted.push_back(d.model.predict(r));
  d.safe = compensation::learn_fail_safe(training, {"X1", "X2", "X3", "X4", "spindle"}, predicted, from_start);
  std::vector<std::vector<double>> starts(2);
  for (std::size_t r = 0; r < training.size(); ++r) {
    for (const FailSafe::Guard& g : d.safe.guards) starts[r].push_back(training[r].at(g.input).values.front());
  }
  const std::vector<double> rise = {6.0, 1.0, 3.5, 6.0, 0.0};  // as of warm_machine() at its start
  compensation::watch_start(d.safe, starts, rise, compensation::FormulaPredictor(d.model).memory_s());
  d.interval_um = 2.0 / 7.0;
  return d;
}

/// The mean of two formulas of that machine, of which one is 40 % larger and the other as much smaller, as a blend whose
/// weights move with probings.
inline compensation::DeployedPredictor deployed_blend() {
  DeployedModel mean = deployed(true, 60.0);
  std::vector<DriftModel> members(2, mean.model);
  for (std::size_t k = 0; k < 2; ++k) {
    members[k].intercept *= k == 0 ? 1.4 : 0.6;
    for (DriftModel::Term& t : members[k].terms) t.coefficient *= k == 0 ? 1.4 : 0.6;
  }
  compensation::DeployedPredictor d;
  d.name = "blend";
  d.target = "drift_y";
  d.from_start = true;
  d.sensors = {"X1", "X2", "X3", "X4"};
  d.interval_um = mean.interval_um;
  d.fail_safe = mean.safe;
  d.predictor = std::make_shared<compensation::FormulaPredictor>(std::move(mean.model), std::move(members));
  d.residual = compensation::ResidualProcess{4.0, 5400.0, 0.1};
  d.member_residuals = {{"large", {5.0, 3600.0, 0.1}}, {"small", {3.0, 7200.0, 0.1}}};
  d.probe = {0.6, 0.0};
  return d;
}

}  // namespace driftwright::fixtures
