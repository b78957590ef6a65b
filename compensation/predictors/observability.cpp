#include "compensation/predictors/observability.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/dense.hpp"
#include "base/errors.hpp"
#include "solver/model_factors.hpp"
#include "solver/propagator.hpp"

namespace driftwright::compensation {
namespace {

constexpr std::size_t kEvery = 10;  // rows
constexpr double kStep = 0.01;      // of a factor, for its derivative

/// Outputs at every tenth row of all runs, side by side.
Eigen::MatrixXd outputs_of(const solver::ReducedSystem& system, const Eigen::VectorXd& start,
                           std::span<const MachineRun> runs) {
  solver::Propagator propagator(system);
  Eigen::MatrixXd all(system.outputs.state.cols(), 0);
  for (const MachineRun& run : runs) {
    std::vector<double> times_s;
    for (std::size_t i = kEvery; i < run.readings.n_samples(); i += kEvery) times_s.push_back(run.readings.time_s[i]);
    if (times_s.empty()) continue;
    const Eigen::MatrixXd outputs = propagator.run(run.cyclogram, run.ambient, times_s, start).outputs;
    all.conservativeResize(Eigen::NoChange, all.cols() + outputs.cols());
    all.rightCols(outputs.cols()) = outputs;
  }
  return all;
}

}  // namespace

Selection select_by_observability(const solver::ReducedSystem& system, const Eigen::VectorXd& start,
                                  std::span<const MachineRun> runs, const std::vector<std::string>& candidates,
                                  const std::string& drift, int n, const ObserverSettings& settings) {
  const auto output = [&](const std::string& name) {
    const auto found = std::find(system.outputs.name.begin(), system.outputs.name.end(), name);
    if (found == system.outputs.name.end()) throw InputError(fmt::format("the model has no output '{}'", name));
    return static_cast<Eigen::Index>(found - system.outputs.name.begin());
  };
  const Eigen::MatrixXd nominal = outputs_of(system, start, runs);
  if (nominal.cols() == 0) throw InputError(fmt::format("runs of fewer than {} rows say nothing about sensors", kEvery + 1));
  std::vector<Eigen::MatrixXd> by_factor;  // each n_outputs x n_rows, per standard deviation of the factor
  std::vector<double> factor(system.sources.size() + system.exchanges.size(), 1.0);
  for (double& f : factor) {
    f = 1.0 + kStep;
    const solver::ReducedSystem changed = solver::with_factors(system, solver::flow_factors(system, factor));
    f = 1.0;
    by_factor.push_back((outputs_of(changed, start, runs) - nominal) * (settings.factor / kStep));
  }
  std::vector<Eigen::Index> rows;  // candidates, then the drift
  for (const std::string& name : candidates) rows.push_back(output(name));
  rows.push_back(output(drift));
  const auto m = static_cast<Eigen::Index>(rows.size());
  std::vector<Eigen::MatrixXd> covariance;  // per time, m x m
  for (Eigen::Index t = 0; t < nominal.cols(); ++t) {
    Eigen::MatrixXd j(m, static_cast<Eigen::Index>(by_factor.size()));
    for (std::size_t f = 0; f < by_factor.size(); ++f) {
      for (Eigen::Index r = 0; r < m; ++r)
        j(r, static_cast<Eigen::Index>(f)) = by_factor[f](rows[static_cast<std::size_t>(r)], t);
    }
    covariance.push_back(j * j.transpose());
  }
  const double noise = settings.reading_K * settings.reading_K + settings.model_K * settings.model_K;
  const auto left_um = [&](const std::vector<Eigen::Index>& chosen) {
    double sum = 0.0;
    for (const Eigen::MatrixXd& c : covariance) {
      double variance = c(m - 1, m - 1);
      if (!chosen.empty()) {
        Eigen::MatrixXd readings = c(chosen, chosen);
        readings.diagonal().array() += noise;
        const Eigen::VectorXd cross = c(chosen, m - 1);
        variance -= cross.dot(dense::solve_definite(readings, cross).col(0));
      }
      sum += std::max(0.0, variance);
    }
    return 1e6 * std::sqrt(sum / static_cast<double>(covariance.size()));
  };
  std::vector<Eigen::Index> chosen;
  std::vector<std::string> left = {fmt::format("{:.2f}", left_um(chosen))};
  Selection selection;
  while (static_cast<int>(chosen.size()) < n && static_cast<Eigen::Index>(chosen.size()) + 1 < m) {
    Eigen::Index best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index c = 0; c + 1 < m; ++c) {
      if (std::find(chosen.begin(), chosen.end(), c) != chosen.end()) continue;
      std::vector<Eigen::Index> trial = chosen;
      trial.push_back(c);
      const double um = left_um(trial);
      if (um < least) {
        least = um;
        best = c;
      }
    }
    chosen.push_back(best);
    selection.sensors.push_back(candidates[static_cast<std::size_t>(best)]);
    left.push_back(fmt::format("{:.2f}", least));
  }
  selection.reason =
      fmt::format("of the drift's uncertainty in the model, {} um are left with 0, 1, ... of them", fmt::join(left, ", "));
  return selection;
}

}  // namespace driftwright::compensation
