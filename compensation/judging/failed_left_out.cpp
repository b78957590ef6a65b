#include "compensation/judging/failed_left_out.hpp"

#include <algorithm>
#include <limits>

#include "base/parallel.hpp"
#include "compensation/judging/failed_sensor_runs.hpp"
#include "compensation/predictors/scored_rows.hpp"

namespace driftwright::compensation {
namespace {

/// What is left of one run of a fold with each of the strategy's sensors failed in turn.
/// @return the largest residual in the hidden rows [um]; none without a sensor or a hidden row
std::optional<double> failed_in_fold_um(const MatrixSettings& settings, const FoldedRuns& folds, std::size_t fold,
                                        std::size_t r, const DeployedPredictor& strategy) {
  const StrategySettings& how = settings.strategies;
  const std::vector<bool>& hidden = folds.folds[fold].hidden[r];
  const auto first = std::find(hidden.begin(), hidden.end(), true);
  if (first == hidden.end()) return std::nullopt;
  const JudgedRunOfMachine part{"", settings.fails_in, "", folds.runs[r]};
  std::vector<double> drift_um = scored_readings(part.run, how.target, how.count_from_start).at(how.target).values;
  const auto last = std::find(hidden.rbegin(), hidden.rend(), true).base() - 1;
  for (std::size_t i = 0; i < drift_um.size(); ++i) {
    if (!hidden[i]) drift_um[i] = std::numeric_limits<double>::quiet_NaN();
  }
  const std::vector<double>& t_s = part.run.readings.time_s;
  const auto time_of = [&](auto row) { return t_s[static_cast<std::size_t>(row - hidden.begin())]; };
  auto failed_runs = runs_with_failures(settings, strategy, part, time_of(first), time_of(last));
  failed_runs.erase(failed_runs.begin());  // all sensors intact
  if (failed_runs.empty()) return std::nullopt;
  std::vector<double> peak_um(failed_runs.size());
  parallel_for(peak_um.size(),
               [&](std::size_t c) { peak_um[c] = judge(strategy, failed_runs[c].second, drift_um).scores.after.peak_abs; });
  return *std::max_element(peak_um.begin(), peak_um.end());
}

}  // namespace

std::optional<double> failed_left_out_um(const MatrixSettings& settings, const FoldedRuns& folds,
                                         std::span<const FittedInFold> in_folds) {
  if (!settings.fails_at) return std::nullopt;
  const std::size_t n_runs = folds.runs.size();
  std::vector<std::optional<double>> most_um(in_folds.size() * n_runs);
  parallel_for(most_um.size(), [&](std::size_t job) {
    const FittedInFold& in = in_folds[job / n_runs];
    most_um[job] = failed_in_fold_um(settings, folds, in.fold, job % n_runs, in.fitted);
  });
  std::optional<double> result;
  for (const std::optional<double>& um : most_um) {
    if (um) result = std::max(result.value_or(0.0), *um);
  }
  return result;
}

}  // namespace driftwright::compensation
