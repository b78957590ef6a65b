#include "compensation/judging/left_out.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.hpp"
#include "base/lists.hpp"
#include "base/median.hpp"
#include "compensation/judging/choice.hpp"
#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/score.hpp"
#include "compensation/predictors/scored_rows.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kInterval = 0.95;
constexpr std::size_t kMostRows = 500;  // of a left-out part that a residual's process is fitted to
// With the last one the clamp allows five times the drift of the training runs.
constexpr double kRooms[] = {1.0, 2.0, 4.0, 8.0};

using PerFold = std::vector<std::vector<double>>;

/// Measured minus predicted of each run, or block of a single run, that was left out. Of long ones, rows at equal distances.
std::vector<ResidualSeries> residuals_of(const PerFold& predictions, const FoldedRuns& f) {
  std::vector<ResidualSeries> all;
  for (std::size_t k = 0; k < predictions.size(); ++k) {
    if (f.folds[k].kind != "run" && f.folds[k].kind != "block") continue;
    ResidualSeries series;
    std::size_t at = 0;
    for (std::size_t r = 0; r < f.runs.size(); ++r) {
      for (std::size_t i = 0; i < f.folds[k].hidden[r].size(); ++i) {
        if (!f.folds[k].hidden[r][i]) continue;
        const double off_um = f.measured_um[k][at] - predictions[k][at];
        ++at;
        if (!std::isfinite(off_um)) continue;
        series.time_s.push_back(f.runs[r].readings.time_s[i]);
        series.off_um.push_back(off_um);
      }
    }
    const std::size_t step = series.time_s.size() / kMostRows + 1;
    ResidualSeries thinned;
    for (std::size_t i = 0; i < series.time_s.size(); i += step) {
      thinned.time_s.push_back(series.time_s[i]);
      thinned.off_um.push_back(series.off_um[i]);
    }
    all.push_back(std::move(thinned));
  }
  return all;
}

/// White noise of the target, at most as stated: half of the mean square from row to row is the most that it can be.
double noise_in(std::span<const ResidualSeries> series, double stated_um) {
  double square = 0.0, n = 0.0;
  for (const ResidualSeries& s : series) {
    for (std::size_t i = 1; i < s.off_um.size(); ++i) {
      square += 0.5 * std::pow(s.off_um[i] - s.off_um[i - 1], 2);
      n += 1.0;
    }
  }
  return n > 0.0 ? std::min(stated_um, std::sqrt(square / n)) : stated_um;
}

/// What the limits of a fail-safe are learned from.
struct Seen {
  std::vector<Record> readings;
  std::vector<std::vector<double>> predicted_um;
  std::vector<Record> starts;  ///< the first row of each run, as read; nothing but NaN with a lead-in
};
Record first_row(const MachineRun& run) {
  Record row{.source = run.readings.source, .time_s = {run.readings.time_s.front()}, .channels = {}};
  for (const Channel& c : run.readings.channels) {
    const bool is_start = run.n_before == 0;
    row.channels.push_back({c.name, c.unit, {is_start ? c.values.front() : std::numeric_limits<double>::quiet_NaN()}});
  }
  return row;
}

Seen seen_in(const Predictor& predictor, std::span<const MachineRun> training, bool from_start) {
  Seen seen;
  // the lead-in of a run is followed, but sets no limits: its rows may belong to judged runs
  for (const MachineRun& run : training) {
    const std::vector<double> drift_um = live(predictor, run);
    seen.predicted_um.emplace_back(drift_um.begin() + static_cast<std::ptrdiff_t>(run.n_before), drift_um.end());
    seen.starts.push_back(first_row(run));
    seen.readings.push_back(own_rows(from_start ? counted_from_start(run.readings, {}) : run.readings, run.n_before));
  }
  return seen;
}

/// The rows of a run that a fold hides: those from a hidden target on until the next one that is not hidden, and all before
/// the first target if that is hidden. Readings often come between targets.
std::vector<bool> hidden_rows(const MachineRun& run, const std::string& target, const std::vector<bool>& hidden) {
  const std::vector<double>& drift = run.readings.at(target).values;
  const auto is_target = [](double v) { return std::isfinite(v); };
  const auto first =
      std::find_if(drift.begin() + static_cast<std::ptrdiff_t>(run.n_before), drift.end(), is_target) - drift.begin();
  bool is_hidden = static_cast<std::size_t>(first) < hidden.size() && hidden[static_cast<std::size_t>(first)];
  std::vector<bool> rows;
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    if (i >= run.n_before && is_target(drift[i])) is_hidden = hidden[i];
    rows.push_back(is_hidden);
  }
  return rows;
}

/// The same of the rows of a fold that are not hidden.
Seen seen_in(const Predictor& predictor, const FoldedRuns& folds, std::size_t fold, const LeftOutSettings& s) {
  Seen seen = seen_in(predictor, folds.runs, s.from_start);
  for (std::size_t r = 0; r < folds.runs.size(); ++r) {
    const std::vector<bool> hidden = hidden_rows(folds.runs[r], s.target, folds.folds[fold].hidden[r]);
    const std::size_t n_before = folds.runs[r].n_before;
    for (Channel& c : seen.starts[r].channels) {
      if (hidden.front()) c.values.front() = std::numeric_limits<double>::quiet_NaN();
    }
    for (std::size_t i = n_before; i < hidden.size(); ++i) {
      if (!hidden[i]) continue;
      seen.predicted_um[r][i - n_before] = std::numeric_limits<double>::quiet_NaN();
      for (Channel& c : seen.readings[r].channels) c.values[i - n_before] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return seen;
}

/// The first readings of each run, in the order of the guards.
std::vector<std::vector<double>> starts_of(const Seen& seen, const FailSafe& safe) {
  std::vector<std::vector<double>> starts;
  for (const Record& row : seen.starts) {
    starts.emplace_back();
    for (const FailSafe::Guard& g : safe.guards) starts.back().push_back(row.at(g.input).values.front());
  }
  return starts;
}

/// Of each guard, the mean over all rows of its reading minus that at the run's start.
std::vector<double> rise_of(const Seen& seen, const FailSafe& safe) {
  std::vector<double> rise;
  for (const FailSafe::Guard& g : safe.guards) {
    double sum = 0.0, n = 0.0;
    for (std::size_t r = 0; r < seen.readings.size(); ++r) {
      const double start = seen.starts[r].at(g.input).values.front();
      if (!std::isfinite(start)) continue;
      for (double x : seen.readings[r].at(g.input).values) {
        if (!std::isfinite(x)) continue;
        sum += safe.from_start && !is_drive(g.unit) ? x : x - start;
        n += 1.0;
      }
    }
    rise.push_back(n > 0.0 ? sum / n : std::numeric_limits<double>::quiet_NaN());
  }
  return rise;
}

/// Fail-safes of a fold with each room. Relations replace readings that are missing or jump; whether they would doubt sound
/// ones is not tried.
std::vector<FailSafe> fail_safes_of(const Seen& seen, const Predictor& predictor, const std::vector<std::string>& inputs,
                                    const LeftOutSettings& s) {
  std::vector<FailSafe> list;
  for (double room : kRooms)
    list.push_back(learn_limits(seen.readings, inputs, seen.predicted_um, s.from_start, true, room));
  try {
    const FailSafe related =
        learn_fail_safe(seen.readings, inputs, seen.predicted_um, s.from_start, true, 1.0, Redundancy::kReplaces);
    for (FailSafe& safe : list) {
      for (std::size_t k = 0; k < safe.guards.size(); ++k) {
        safe.guards[k].others_intercept = related.guards[k].others_intercept;
        safe.guards[k].others_coefficient = related.guards[k].others_coefficient;
        safe.guards[k].most_apart = related.guards[k].most_apart;
      }
    }
  } catch (const InputError&) {  // no row of the rest has all readings: nothing is replaced
  }
  for (FailSafe& safe : list) {
    watch_start(safe, starts_of(seen, safe), rise_of(seen, safe), predictor.memory_s());
    limit(safe, s.limits);
  }
  return list;
}

FailSafe learned(const Seen& seen, const Predictor& predictor, const LeftOutSettings& s, double room) {
  FailSafe safe =
      learn_fail_safe(seen.readings, names_of(guarded_inputs(predictor)), seen.predicted_um, s.from_start, true, room);
  watch_start(safe, starts_of(seen, safe), rise_of(seen, safe), predictor.memory_s());
  limit(safe, s.limits);
  return safe;
}

/// The runs of a fold that have hidden rows, as a predictor follows them.
std::vector<std::pair<std::size_t, PredictedDrift>> followed(const Predictor& predictor, const FailSafe& safe,
                                                             const FoldedRuns& folds, std::size_t fold) {
  std::vector<std::pair<std::size_t, PredictedDrift>> runs;
  for (std::size_t r = 0; r < folds.runs.size(); ++r) {
    const std::vector<bool>& hidden = folds.folds[fold].hidden[r];
    if (std::find(hidden.begin(), hidden.end(), true) != hidden.end())
      runs.emplace_back(r, predict(predictor, safe, folds.runs[r]));
  }
  return runs;
}

/// What a correction leaves in the hidden rows.
std::vector<double> left_um(const std::vector<std::pair<std::size_t, PredictedDrift>>& runs, const FailSafe& safe,
                            const FoldedRuns& folds, std::size_t fold) {
  std::vector<double> left;
  for (const auto& [r, run] : runs) {
    const GuardedCorrection c = guarded(safe, run.readings, run.drift_um);
    for (std::size_t i = 0; i < c.correction_um.size(); ++i) {
      if (folds.folds[fold].hidden[r][i]) left.push_back(folds.measured_um[fold][left.size()] - c.correction_um[i]);
    }
  }
  return left;
}

std::vector<double> absolute_errors(const std::vector<double>& measured_um, const std::vector<double>& predicted_um) {
  std::vector<double> off;
  for (std::size_t i = 0; i < predicted_um.size(); ++i) off.push_back(std::abs(measured_um[i] - predicted_um[i]));
  return off;
}

}  // namespace

FoldPredictors fold_predictors(const std::function<std::shared_ptr<const Predictor>(std::span<const MachineRun>)>& fit,
                               const FoldedRuns& folds) {
  FoldPredictors predictors;
  try {
    for (const std::vector<MachineRun>& rest : folds.rest) predictors.push_back(fit(rest));
  } catch (const InputError&) {  // too little data remains
    return {};
  } catch (const SolveError&) {
    return {};
  }
  return predictors;
}

double set_left_out(DeployedPredictor& d, const FoldPredictors& predictors, const FoldedRuns& folds,
                    const LeftOutSettings& s) {
  PerFold predictions;
  for (std::size_t k = 0; k < predictors.size(); ++k) predictions.push_back(folds.predicted_um(*predictors[k], k));
  const std::vector<ResidualSeries> series = residuals_of(predictions, folds);
  d.residual = fit_residual_process(series, noise_in(series, s.drift_um));
  for (std::size_t k = 0; k < predictions.size(); ++k) {
    const std::vector<double> off = absolute_errors(folds.measured_um[k], predictions[k]);
    d.fold_errors.push_back({folds.folds[k].kind, folds.folds[k].name, score(off).rmse, quantile(off, kInterval)});
    d.interval_um = std::max(d.interval_um.value_or(0.0), d.fold_errors.back().within_um);
  }
  if (d.is_baseline || predictors.empty()) return 1.0;
  const std::vector<std::string> inputs = names_of(guarded_inputs(*d.predictor));
  std::vector<DeployedPredictor> tried(std::size(kRooms));
  for (std::size_t k = 0; k < predictors.size(); ++k) {
    const std::vector<FailSafe> safes = fail_safes_of(seen_in(*predictors[k], folds, k, s), *predictors[k], inputs, s);
    std::vector<std::pair<std::size_t, PredictedDrift>> runs;
    for (std::size_t n = 0; n < tried.size(); ++n) {
      // without inputs to repair the prediction does not depend on the room
      if (n == 0 || !inputs.empty()) runs = followed(*predictors[k], safes[n], folds, k);
      FoldError error = d.fold_errors[k];
      error.rms_um = score(left_um(runs, safes[n], folds, k)).rmse;
      tried[n].fold_errors.push_back(std::move(error));
    }
  }
  const auto least = std::min_element(
      tried.begin(), tried.end(),
      [](const DeployedPredictor& a, const DeployedPredictor& b) { return left_out_um(a) < left_out_um(b); });
  d.fold_errors = least->fold_errors;
  return kRooms[least - tried.begin()];
}

FailSafe fail_safe_of(const Predictor& predictor, std::span<const MachineRun> training, const LeftOutSettings& s,
                      double room) {
  return learned(seen_in(predictor, training, s.from_start), predictor, s, room);
}

FailSafe fail_safe_in_fold(const Predictor& predictor, const FoldedRuns& folds, std::size_t fold, const LeftOutSettings& s,
                           double room) {
  return learned(seen_in(predictor, folds, fold, s), predictor, s, room);
}

}  // namespace driftwright::compensation
