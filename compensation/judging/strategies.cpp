#include "compensation/judging/strategies.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "base/errors.hpp"
#include "base/median.hpp"
#include "base/parallel.hpp"
#include "compensation/judging/folds.hpp"
#include "compensation/predictors/blended_formula.hpp"
#include "compensation/predictors/fitted_formulas.hpp"
#include "compensation/predictors/formula_predictor.hpp"
#include "compensation/predictors/memory_regression.hpp"
#include "compensation/predictors/observability.hpp"
#include "compensation/predictors/past_drift.hpp"
#include "compensation/predictors/score.hpp"
#include "compensation/sensors/blocks.hpp"
#include "compensation/sensors/sensor_selection.hpp"
#include "solver/propagator.hpp"

namespace driftwright::compensation {
namespace {

using namespace compensation;

constexpr double kInterval = 0.95;
constexpr std::size_t kMostRows = 500;  // of a left-out part that a residual's process is fitted to
// Share of the drift of a left-out part. A prediction that leaves more is not valid there; applying only a quarter of it
// would leave less.
constexpr double kHolds = 0.5;

/// A strategy before it is fitted.
struct Strategy {
  std::string name;
  bool is_baseline = false;
  std::function<DeployedPredictor(std::span<const ObservedRun>)> fit;
  bool is_blended = false;  ///< it takes part in the blend
};

/// One record per run.
std::vector<Record> records_of(std::span<const ObservedRun> runs, const StrategySettings& s) {
  std::vector<Record> records;
  for (const ObservedRun& run : runs) records.push_back(scored_readings(run, s.target, s.count_from_start));
  return records;
}

/// One record per history, for any number of runs cut from it: equal rows give an equal fit.
std::vector<Record> whole_records_of(std::span<const ObservedRun> runs, const StrategySettings& s) {
  return records_of(joined_histories(runs, s.target), s);
}

void require_thermometers(const StrategySettings& s) {
  if (s.candidates.empty()) throw InputError("there is no thermometer to choose from");
}

/// Includes the ambient.
std::vector<std::string> thermometers_of(const StrategySettings& s) {
  std::vector<std::string> names = s.candidates;
  if (!s.ambient.empty() && std::find(names.begin(), names.end(), s.ambient) == names.end()) names.push_back(s.ambient);
  return names;
}

DeployedPredictor deployed(std::shared_ptr<const Predictor> predictor, const StrategySettings& s) {
  DeployedPredictor d;
  d.target = s.target;
  d.from_start = s.count_from_start;
  d.predictor = std::move(predictor);
  return d;
}

Strategy baseline(const std::string& name, const StrategySettings& s,
                  std::function<std::shared_ptr<const Predictor>(const std::vector<Record>&)> make) {
  return {name, true, [s, make](std::span<const ObservedRun> training) {
            std::vector<Record> records = records_of(training, s);
            for (std::size_t r = 0; r < records.size(); ++r)
              records[r] = own_rows(std::move(records[r]), training[r].n_before);
            return deployed(make(records), s);
          }};
}

/// A formula of channels.
DeployedPredictor of_formula(DriftModel model, std::string reason, const StrategySettings& s) {
  model.from_start = s.count_from_start;
  std::vector<std::string> sensors = model.inputs();
  std::erase(sensors, s.speed);
  DeployedPredictor d = deployed(std::make_shared<FormulaPredictor>(std::move(model)), s);
  d.sensors = std::move(sensors);
  d.reason = std::move(reason);
  return d;
}

Strategy regression_on(const std::string& name, const StrategySettings& s,
                       std::function<Selection(std::span<const ObservedRun>, const std::vector<Record>&)> select) {
  return {name, false, [s, select](std::span<const ObservedRun> training) {
            require_thermometers(s);
            const std::vector<Record> records = in_blocks(whole_records_of(training, s), s.target);
            const Selection selection = select(training, records);
            if (selection.sensors.empty()) throw InputError("no sensor was chosen");
            return of_formula(as_drift_model(fit_regression(records, selection.sensors, s.target)),
                              fmt::format("{}: {}", fmt::join(selection.sensors, ", "), selection.reason), s);
          }};
}

using FormulaFit = FittedFormula (*)(std::span<const Record>, const std::vector<std::string>&, const std::string&);
Strategy formula_of_all(const std::string& name, const StrategySettings& s, FormulaFit fit) {
  return {name, false, [s, fit](std::span<const ObservedRun> training) {
            require_thermometers(s);
            FittedFormula f = fit(in_blocks(whole_records_of(training, s), s.target), thermometers_of(s), s.target);
            return of_formula(std::move(f.model), std::move(f.reason), s);
          }};
}

Strategy remembering(const std::string& name, const StrategySettings& s, Columns columns, int n_modes = 0,
                     bool needs = true) {
  return {name, false,
          [s, columns, n_modes, needs](std::span<const ObservedRun> training) {
            if (needs) require_thermometers(s);
            FittedFormula f = fit_with_memories(whole_records_of(training, s), s.candidates, s.speed, s.ambient, s.target,
                                                columns, n_modes);
            return of_formula(std::move(f.model), std::move(f.reason), s);
          },
          true};
}

/// The best-known factors, relative to their prior.
std::string words(std::vector<Observer::Factor> factors) {
  constexpr std::size_t kShown = 8;
  std::stable_sort(factors.begin(), factors.end(), [](const auto& a, const auto& b) { return a.deviation < b.deviation; });
  std::vector<std::string> text;
  for (std::size_t i = 0; i < std::min(kShown, factors.size()); ++i)
    text.push_back(fmt::format("{} {:.2f} +- {:.2f}", factors[i].name, factors[i].value, factors[i].deviation));
  return fmt::format("{}", fmt::join(text, ", "));
}

/// Runs cut from longer records, without readings in rows that belong to none of them: an observer must not learn from
/// these.
std::vector<ObservedRun> without_others_readings(std::vector<ObservedRun> histories, const StrategySettings& s) {
  for (ObservedRun& run : histories) {
    if (run.history.empty()) continue;
    const std::vector<double> drift = run.readings.at(s.target).values;
    for (Channel& c : run.readings.channels) {
      if (std::find(s.candidates.begin(), s.candidates.end(), c.name) == s.candidates.end()) continue;
      for (std::size_t i = 0; i < drift.size(); ++i) {
        if (std::isnan(drift[i])) c.values[i] = drift[i];
      }
    }
  }
  return histories;
}

/// An observer with or without sensors, trained on the training runs or not.
Strategy observing(const std::string& name, const StrategySettings& s, bool with_sensors, bool learns) {
  return {name, false, [s, with_sensors, learns](std::span<const ObservedRun> training) {
            const Physics& p = *s.physics;
            const ObserverSettings how{.reading_K = s.reading_K, .drift_um = s.drift_um};
            const std::vector<ObservedRun> histories = joined_histories(training, s.target);
            DeployedPredictor f;
            Selection selection;
            if (with_sensors) {
              selection = select_by_observability(p.system, p.start, histories, s.candidates, s.target, s.n_sensors, how);
              f.reason = fmt::format("{}: {}", fmt::join(selection.sensors, ", "), selection.reason);
            }
            Observer observer(p.system, p.start, p.start_ambient_K, learns ? s.candidates : selection.sensors, s.target,
                              how);
            if (learns) {
              observer.learn(without_others_readings(histories, s));
              f.reason += fmt::format("{}factors learned: {}", f.reason.empty() ? "" : "; ", words(observer.factors()));
              observer = observer.with_sensors(selection.sensors).calibrated(without_others_readings(histories, s));
            }
            if (p.linearised) {
              f.model = words_of(*p.linearised);
              f.reason += fmt::format("{}model {}, in the training runs at most {:.2g} um from the nonlinear one",
                                      f.reason.empty() ? "" : "; ", f.model, p.linearised->error_um);
            }
            f.target = s.target;
            f.from_start = true;
            f.predictor = std::make_shared<Observer>(std::move(observer));
            f.sensors = selection.sensors;
            if (!s.ambient.empty() && std::find(f.sensors.begin(), f.sensors.end(), s.ambient) == f.sensors.end())
              f.sensors.push_back(s.ambient);
            return f;
          }};
}

std::vector<Strategy> strategies(const StrategySettings& s) {
  const auto by_record_selector = [&](decltype(Selector::select) select, int n) {
    return [s, select, n](std::span<const ObservedRun>, const std::vector<Record>& records) {
      return select(records, s.candidates, s.target, n);
    };
  };
  std::vector<Strategy> list;
  const Record moment{.source = {}, .time_s = {0.0}, .channels = {}};
  list.push_back(
      baseline(kNoCorrection, s, [](const std::vector<Record>&) { return std::make_shared<ConstantPredictor>(0.0); }));
  list.push_back(baseline("mean of the training runs", s, [s, moment](const std::vector<Record>& training) {
    return std::make_shared<ConstantPredictor>(baseline_mean(training, moment, s.target).front());
  }));
  list.push_back(baseline("last value of the training runs", s, [s, moment](const std::vector<Record>& training) {
    return std::make_shared<ConstantPredictor>(baseline_last(training, moment, s.target).front());
  }));
  list.push_back(baseline("training runs at the same time", s, [s](const std::vector<Record>& training) {
    return std::make_shared<EarlierRunsPredictor>(training, s.target);
  }));
  const std::vector<Selector> by_records = selectors({.image = s.image});
  list.push_back(regression_on("one thermometer", s, by_record_selector(by_records.front().select, 1)));
  for (const Selector& selector : by_records)
    list.push_back(regression_on("regression, " + selector.name, s, by_record_selector(selector.select, s.n_sensors)));
  if (s.physics) {
    list.push_back(regression_on(
        "regression, observability", s, [s](std::span<const ObservedRun> training, const std::vector<Record>&) {
          const Physics& p = *s.physics;
          return select_by_observability(p.system, p.start, joined_histories(training, s.target), s.candidates, s.target,
                                         s.n_sensors, {.reading_K = s.reading_K});
        }));
  }
  list.push_back(formula_of_all("ridge, all sensors", s, fit_ridge));
  list.back().is_blended = true;
  list.push_back(formula_of_all("principal components, all sensors", s, fit_principal_components));
  list.push_back(formula_of_all("partial least squares, all sensors", s, fit_partial_least_squares));
  list.push_back({"regression with lags", false, [s](std::span<const ObservedRun> training) {
                    require_thermometers(s);
                    const std::vector<Record> whole = whole_records_of(training, s), records = in_blocks(whole, s.target);
                    const Selection selection = select_forward(records, s.candidates, s.target, s.n_sensors);
                    FittedFormula f = fit_with_lags(records, selection.sensors, s.target, longest_lag_s(whole, s.target));
                    return of_formula(std::move(f.model),
                                      fmt::format("{}; {}", fmt::join(selection.sensors, ", "), f.reason), s);
                  }});
  if (!s.speed.empty()) {
    list.push_back({"transfer functions from speed", false, [s](std::span<const ObservedRun> training) {
                      const std::vector<Record> whole = whole_records_of(training, s);
                      FittedFormula f = fit_from_speed(in_blocks(whole, s.target), s.speed, s.ambient, s.target,
                                                       longest_lag_s(whole, s.target));
                      return of_formula(std::move(f.model), std::move(f.reason), s);
                    }});
    StrategySettings open = s;
    open.candidates.clear();
    list.push_back(remembering("drive and ambient, memories", open, Columns::kAndMemories, 0, false));
    list.back().is_blended = s.candidates.empty();
    list.push_back(remembering("thermometers and drive", s, Columns::kAndDrive));
  }
  for (const int n_modes : {3, 4})
    list.push_back(remembering(fmt::format("{} common modes and memories", n_modes), s, Columns::kModes, n_modes));
  list.push_back(remembering("thermometers and memories", s, Columns::kAndMemories));
  if (s.physics) {
    list.push_back(observing("thermal modes of the model", s, false, false));
    list.push_back(observing("model fitted to the training runs", s, false, true));
    list.push_back(observing("observer", s, true, true));
  }
  return list;
}

/// The predictions of a strategy for each fold, fitted to the rest; empty if it cannot be fitted to one of the rests.
using LeftOutPredictions = std::vector<std::vector<double>>;
LeftOutPredictions left_out_predictions(const Strategy& strategy, const FoldedRuns& f) {
  LeftOutPredictions predictions;
  try {
    for (std::size_t k = 0; k < f.folds.size(); ++k)
      predictions.push_back(f.predicted_um(*strategy.fit(f.rest[k]).predictor, k));
  } catch (const InputError&) {  // too little data remains
    return {};
  } catch (const SolveError&) {
    return {};
  }
  return predictions;
}

/// Measured minus predicted of each run, or block of a single run, that was left out. Of long ones, rows at equal distances.
std::vector<ResidualSeries> residuals_of(const LeftOutPredictions& predictions, const FoldedRuns& f) {
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

/// Sets the errors and the interval.
void set_left_out(DeployedPredictor& d, const LeftOutPredictions& predictions, const FoldedRuns& f,
                  const StrategySettings& s) {
  if (s.probing) {
    const std::vector<ResidualSeries> series = residuals_of(predictions, f);
    d.residual = fit_residual_process(series, noise_in(series, s.drift_um));
  }
  for (std::size_t k = 0; k < predictions.size(); ++k) {
    std::vector<double> off;
    for (std::size_t i = 0; i < predictions[k].size(); ++i) off.push_back(std::abs(f.measured_um[k][i] - predictions[k][i]));
    d.fold_errors.push_back({f.folds[k].kind, f.folds[k].name, score(off).rmse, quantile(off, kInterval)});
    d.interval_um = std::max(d.interval_um.value_or(0.0), d.fold_errors.back().within_um);
  }
}

/// The range beyond its training range in which each input may be used, because the predictor was accurate there: over the
/// folds in which it left less than kHolds of the drift, the largest excess of the hidden rows over the others.
std::vector<Reach> reach_of(const DeployedPredictor& f, const StrategySettings& s, const FoldedRuns& folds) {
  std::vector<Record> readings;
  for (const ObservedRun& run : folds.runs) readings.push_back(scored_readings(run, s.target, s.count_from_start));
  std::vector<Reach> reach;
  for (const Input& input : f.predictor->inputs()) {
    Reach r{.input = input.name};
    for (std::size_t k = 0; k < f.fold_errors.size(); ++k) {
      // about its mean, because an offset of the target is not a drift
      std::vector<double> drift_um = folds.measured_um[k];
      const double mean_um = score(drift_um).mean;
      for (double& um : drift_um) um -= mean_um;
      if (!(f.fold_errors[k].rms_um <= kHolds * score(drift_um).rmse)) continue;
      constexpr double kFar = std::numeric_limits<double>::infinity();
      double low = kFar, high = -kFar, hidden_low = kFar, hidden_high = -kFar;
      for (std::size_t n = 0; n < folds.runs.size(); ++n) {
        const std::vector<double>&x = readings[n].at(input.name).values, &drift = readings[n].at(s.target).values;
        for (std::size_t i = 0; i < x.size(); ++i) {
          if (!std::isfinite(x[i]) || !std::isfinite(drift[i])) continue;
          double &least = folds.folds[k].hidden[n][i] ? hidden_low : low,
                 &most = folds.folds[k].hidden[n][i] ? hidden_high : high;
          least = std::min(least, x[i]);
          most = std::max(most, x[i]);
        }
      }
      if (!std::isfinite(low - hidden_low)) continue;  // nothing was read on one side of the fold
      r.below = std::max(r.below, low - hidden_low);
      r.above = std::max(r.above, hidden_high - high);
    }
    reach.push_back(std::move(r));
  }
  return reach;
}

/// Learns the fail-safe of a predictor.
void guard(DeployedPredictor& f, const StrategySettings& s, std::span<const ObservedRun> training, const FoldedRuns& folds) {
  std::vector<std::vector<double>> predicted;
  // an observer checks its sensors itself
  std::vector<std::string> guarded;
  if (!f.predictor->looks_after_inputs()) {
    for (const Input& input : f.predictor->inputs()) guarded.push_back(input.name);
  }
  std::vector<Record> readings;
  // the lead-in of a run is followed, but sets no limits: its rows may belong to judged runs
  for (const ObservedRun& run : training) {
    const std::vector<double> drift_um = live(*f.predictor, run);
    predicted.emplace_back(drift_um.begin() + static_cast<std::ptrdiff_t>(run.n_before), drift_um.end());
    readings.push_back(own_rows(s.count_from_start ? counted_from_start(run.readings, {}) : run.readings, run.n_before));
  }
  f.fail_safe = learn_fail_safe(readings, guarded, predicted, s.count_from_start, true, reach_of(f, s, folds));
  limit(*f.fail_safe, s.limits);
}

/// Fits a strategy, without its errors on left-out rows and without fail-safe.
DeployedPredictor fit_one(const Strategy& strategy, const StrategySettings& s, std::span<const ObservedRun> training) {
  DeployedPredictor f = strategy.fit(training);
  f.name = strategy.name;
  f.is_baseline = strategy.is_baseline;
  f.ambient = s.ambient;
  return f;
}

/// A member of a blend.
struct Member {
  DeployedPredictor deployed;
  LeftOutPredictions predictions;
};

/// The mean of the members whose error on left-out rows is about equal to the smallest; none if only one qualifies.
std::optional<DeployedPredictor> blend(std::vector<Member> members, const FoldedRuns& folds, const StrategySettings& s,
                                       std::span<const ObservedRun> training) {
  double least = std::numeric_limits<double>::infinity();
  for (const Member& m : members) least = std::min(least, left_out_um(m.deployed));
  std::erase_if(members, [&](const Member& m) { return !(left_out_um(m.deployed) <= kAlike * least); });
  if (members.size() < 2) return std::nullopt;
  const double share = 1.0 / static_cast<double>(members.size());
  LeftOutPredictions mean = members.front().predictions;
  std::vector<DriftModel> models;
  std::vector<std::string> names;
  for (std::size_t m = 0; m < members.size(); ++m) {
    for (std::size_t k = 0; k < mean.size(); ++k) {
      for (std::size_t i = 0; i < mean[k].size(); ++i)
        mean[k][i] = (m == 0 ? 0.0 : mean[k][i]) + share * members[m].predictions[k][i];
    }
    models.push_back(*as_formula(*members[m].deployed.predictor));
    names.push_back(members[m].deployed.name);
  }
  DeployedPredictor d = of_formula(mean_of(models, kBlend), fmt::format("the mean of {}", fmt::join(names, "; ")), s);
  d.name = kBlend;
  d.ambient = s.ambient;
  set_left_out(d, mean, folds, s);
  guard(d, s, training, folds);
  return d;
}

}  // namespace

std::string words_of(const LinearisedModel& model) {
  const auto [low, high] = std::minmax_element(model.laws.begin(), model.laws.end(),
                                               [](const auto& a, const auto& b) { return a.at_K < b.at_K; });
  const std::string coldest = fmt::format("{:.0f}", low->at_K - 273.15),
                    hottest = fmt::format("{:.0f}", high->at_K - 273.15);
  return coldest == hottest ? fmt::format("linearised at {} °C", coldest)
                            : fmt::format("linearised at {} to {} °C", coldest, hottest);
}

FittedStrategies fit_strategies(const StrategySettings& settings, std::span<const ObservedRun> training) {
  const std::vector<Strategy> list = strategies(settings);
  const FoldedRuns folds = folded(training, {.target = settings.target,
                                             .from_start = settings.count_from_start,
                                             .thermometers = thermometers_of(settings),
                                             .speed = settings.speed});
  std::vector<std::optional<DeployedPredictor>> fitted(list.size());
  std::vector<LeftOutPredictions> predictions(list.size());
  std::vector<std::string> why(list.size());
  parallel_for(list.size(), [&](std::size_t i) {
    try {
      fitted[i] = fit_one(list[i], settings, training);
      predictions[i] = left_out_predictions(list[i], folds);
      set_left_out(*fitted[i], predictions[i], folds, settings);
      if (!fitted[i]->is_baseline) guard(*fitted[i], settings, training, folds);
    } catch (const InputError& e) {
      why[i] = e.what();
    } catch (const SolveError& e) {  // the model has no solution there
      why[i] = e.what();
    }
  });
  FittedStrategies result;
  std::vector<Member> members;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!fitted[i]) {
      result.left_out.push_back({list[i].name, why[i]});
      continue;
    }
    if (list[i].is_blended && !predictions[i].empty()) members.push_back({*fitted[i], predictions[i]});
    result.strategies.push_back(std::move(*fitted[i]));
  }
  if (std::optional<DeployedPredictor> mean = blend(members, folds, settings, training))
    result.strategies.push_back(std::move(*mean));
  if (!settings.physics && !settings.without_physics.empty())
    result.left_out.push_back({"thermal modes, fitted model and observer", settings.without_physics});
  result.choice = choose(result.strategies);
  return result;
}

}  // namespace driftwright::compensation
