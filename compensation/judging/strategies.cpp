#include "compensation/judging/strategies.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "compensation/predictors/fitted_formulas.hpp"
#include "compensation/predictors/formula_predictor.hpp"
#include "compensation/predictors/memory_regression.hpp"
#include "compensation/predictors/observability.hpp"
#include "compensation/predictors/past_drift.hpp"
#include "compensation/predictors/score.hpp"
#include "compensation/sensors/sensor_selection.hpp"
#include "solver/propagator.hpp"

namespace driftwright::compensation {
namespace {

using namespace compensation;

constexpr double kInterval = 0.95;

/// A strategy before it is fitted.
struct Strategy {
  std::string name;
  bool is_baseline = false;
  std::function<DeployedPredictor(std::span<const ObservedRun>)> fit;
};

std::vector<Record> records_of(std::span<const ObservedRun> runs, const StrategySettings& s) {
  std::vector<Record> records;
  for (const ObservedRun& run : runs) records.push_back(scored_readings(run, s.target, s.count_from_start));
  return records;
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
            const std::vector<Record> records = records_of(training, s);
            const Selection selection = select(training, records);
            if (selection.sensors.empty()) throw InputError("no sensor was chosen");
            return of_formula(as_drift_model(fit_regression(records, selection.sensors, s.target)),
                              fmt::format("{}: {}", fmt::join(selection.sensors, ", "), selection.reason), s);
          }};
}

using FormulaFit = FittedFormula (*)(std::span<const Record>, const std::vector<std::string>&, const std::string&);
Strategy formula_of_all(const std::string& name, const StrategySettings& s, FormulaFit fit) {
  return {name, false, [s, fit](std::span<const ObservedRun> training) {
            FittedFormula f = fit(records_of(training, s), s.candidates, s.target);
            return of_formula(std::move(f.model), std::move(f.reason), s);
          }};
}

/// The factors that are known best, against their own prior.
std::string words(std::vector<Observer::Factor> factors) {
  constexpr std::size_t kShown = 8;
  std::stable_sort(factors.begin(), factors.end(), [](const auto& a, const auto& b) { return a.deviation < b.deviation; });
  std::vector<std::string> text;
  for (std::size_t i = 0; i < std::min(kShown, factors.size()); ++i)
    text.push_back(fmt::format("{} {:.2f} +- {:.2f}", factors[i].name, factors[i].value, factors[i].deviation));
  return fmt::format("{}", fmt::join(text, ", "));
}

/// Runs that were cut from longer records without what was read in rows that none of them has as its own: an observer must not learn from them.
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

/// An observer with some sensors, or none, taught by the training runs or not.
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
              observer = observer.with_sensors(selection.sensors);
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
  list.push_back(formula_of_all("principal components, all sensors", s, fit_principal_components));
  list.push_back(formula_of_all("partial least squares, all sensors", s, fit_partial_least_squares));
  list.push_back({"regression with lags", false, [s](std::span<const ObservedRun> training) {
                    const std::vector<Record> records = records_of(training, s);
                    const Selection selection = select_forward(records, s.candidates, s.target, s.n_sensors);
                    FittedFormula f = fit_with_lags(records, selection.sensors, s.target);
                    return of_formula(std::move(f.model),
                                      fmt::format("{}; {}", fmt::join(selection.sensors, ", "), f.reason), s);
                  }});
  if (!s.speed.empty()) {
    list.push_back({"transfer functions from speed", false, [s](std::span<const ObservedRun> training) {
                      FittedFormula f = fit_from_speed(records_of(training, s), s.speed, s.ambient, s.target);
                      return of_formula(std::move(f.model), std::move(f.reason), s);
                    }});
  }
  list.push_back({"thermometers and memories", false, [s](std::span<const ObservedRun> training) {
                    // runs cut from one record are one again: its own blocks tell more of it than two or three runs
                    const std::vector<Record> records = records_of(joined_histories(training, s.target), s);
                    FittedFormula f = fit_with_memories(records, s.candidates, s.speed, s.ambient, s.target);
                    return of_formula(std::move(f.model), std::move(f.reason), s);
                  }});
  if (s.physics) {
    list.push_back(observing("thermal modes of the model", s, false, false));
    list.push_back(observing("model fitted to the training runs", s, false, true));
    list.push_back(observing("observer", s, true, true));
  }
  return list;
}

double quantile(std::vector<double> x, double share) {
  std::sort(x.begin(), x.end());
  return x[static_cast<std::size_t>(std::ceil(share * static_cast<double>(x.size()))) - 1];
}

/// Magnitudes of measured - predicted of a run, without missing ones.
std::vector<double> misses(const DeployedPredictor& f, const ObservedRun& run, const StrategySettings& s) {
  const std::vector<double> predicted = live(*f.predictor, run);
  const std::vector<double> measured = scored_readings(run, s.target, s.count_from_start).at(s.target).values;
  std::vector<double> result;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (std::isfinite(measured[i] - predicted[i])) result.push_back(std::abs(measured[i] - predicted[i]));
  }
  return result;
}

std::optional<double> interval(const Strategy& strategy, const StrategySettings& s, std::span<const ObservedRun> training) {
  if (training.size() < 2) return std::nullopt;
  double half = 0.0;
  for (std::size_t left_out = 0; left_out < training.size(); ++left_out) {
    std::vector<ObservedRun> rest;
    for (std::size_t r = 0; r < training.size(); ++r) {
      if (r != left_out) rest.push_back(training[r]);
    }
    try {
      const std::vector<double> off = misses(strategy.fit(rest), training[left_out], s);
      if (!off.empty()) half = std::max(half, quantile(off, kInterval));
    } catch (const InputError&) {
      return std::nullopt;  // two runs, of which one alone leaves nothing to decide by
    }
  }
  return half;
}

DeployedPredictor fit_one(const Strategy& strategy, const StrategySettings& s, std::span<const ObservedRun> training) {
  DeployedPredictor f = strategy.fit(training);
  f.name = strategy.name;
  f.is_baseline = strategy.is_baseline;
  f.ambient = s.ambient;
  f.interval_um = interval(strategy, s, training);
  if (f.is_baseline) return f;
  std::vector<std::vector<double>> predicted;
  // an observer looks after its sensors itself
  std::vector<std::string> guarded;
  if (const DriftModel* formula = as_formula(*f.predictor)) guarded = formula->inputs();
  std::vector<Record> readings;
  // a run's lead-in is followed, and bounds nothing: its rows may be those that are judged
  for (const ObservedRun& run : training) {
    const std::vector<double> drift_um = live(*f.predictor, run);
    predicted.emplace_back(drift_um.begin() + static_cast<std::ptrdiff_t>(run.n_before), drift_um.end());
    readings.push_back(own_rows(s.count_from_start ? counted_from_start(run.readings, {}) : run.readings, run.n_before));
  }
  f.fail_safe = learn_fail_safe(readings, guarded, predicted, s.count_from_start, true);
  return f;
}

}  // namespace

FittedStrategies fit_strategies(const StrategySettings& settings, std::span<const ObservedRun> training) {
  const std::vector<Strategy> list = strategies(settings);
  std::vector<std::optional<DeployedPredictor>> fitted(list.size());
  std::vector<std::string> why(list.size());
  parallel_for(list.size(), [&](std::size_t i) {
    try {
      fitted[i] = fit_one(list[i], settings, training);
    } catch (const InputError& e) {
      why[i] = e.what();
    } catch (const SolveError& e) {  // a model that has no solution there
      why[i] = e.what();
    }
  });
  FittedStrategies result;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (fitted[i]) {
      result.strategies.push_back(std::move(*fitted[i]));
    } else {
      result.left_out.push_back({list[i].name, why[i]});
    }
  }
  if (!settings.physics && !settings.without_physics.empty())
    result.left_out.push_back({"thermal modes, fitted model and observer", settings.without_physics});
  return result;
}

}  // namespace driftwright::compensation
