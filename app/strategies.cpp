#include "app/strategies.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>

#include "base/errors.hpp"
#include "compensation/fitted_formulas.hpp"
#include "compensation/memory_regression.hpp"
#include "compensation/observability.hpp"
#include "compensation/score.hpp"
#include "compensation/sensor_selection.hpp"
#include "solver/propagator.hpp"

namespace driftwright::app {
namespace {

using namespace compensation;

constexpr double kInterval = 0.95;

/// A strategy before it is fitted.
struct Strategy {
  std::string name;
  bool is_baseline = false;
  std::function<FittedStrategy(std::span<const ObservedRun>)> fit;
};

std::vector<Record> records_of(std::span<const ObservedRun> runs, const StrategySettings& s) {
  std::vector<Record> records;
  for (const ObservedRun& run : runs)
    records.push_back(s.count_from_start ? counted_from_start(run.readings, s.target) : run.readings);
  return records;
}

Strategy baseline(const std::string& name, const StrategySettings& s,
                  std::function<std::vector<double>(const std::vector<Record>&, const Record&)> predict) {
  return {name, true, [s, predict](std::span<const ObservedRun> training) {
            FittedStrategy f;
            f.predict = [predict, records = records_of(training, s)](const ObservedRun& run) {
              return predict(records, run.readings);
            };
            return f;
          }};
}

/// A formula of channels.
FittedStrategy of_formula(DriftModel model, std::string reason, const StrategySettings& s) {
  FittedStrategy f;
  model.from_start = s.count_from_start;
  for (const std::string& input : model.inputs()) {
    if (input != s.speed) f.sensors.push_back(input);
  }
  f.reason = std::move(reason);
  f.predict = [model](const ObservedRun& run) { return model.predict(run.readings); };
  f.model = std::move(model);
  return f;
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

/// An observer with some sensors, or none, taught by the training runs or not.
Strategy observing(const std::string& name, const StrategySettings& s, bool with_sensors, bool learns) {
  return {name, false, [s, with_sensors, learns](std::span<const ObservedRun> training) {
            const Physics& p = *s.physics;
            const ObserverSettings how{.reading_K = s.reading_K, .drift_um = s.drift_um};
            FittedStrategy f;
            Selection selection;
            if (with_sensors) {
              selection = select_by_observability(p.system, p.start, training, s.candidates, s.target, s.n_sensors, how);
              f.sensors = selection.sensors;
              f.reason = fmt::format("{}: {}", fmt::join(selection.sensors, ", "), selection.reason);
            }
            auto observer = std::make_shared<Observer>(p.system, p.start, p.start_hall_K,
                                                       learns ? s.candidates : selection.sensors, s.target, how);
            if (learns) {
              observer->learn(training);
              f.reason += fmt::format("{}factors learned: {}", f.reason.empty() ? "" : "; ", words(observer->factors()));
              observer = std::make_shared<Observer>(observer->with_sensors(selection.sensors));
            }
            if (!s.hall.empty() && std::find(f.sensors.begin(), f.sensors.end(), s.hall) == f.sensors.end())
              f.sensors.push_back(s.hall);
            f.predict = [observer](const ObservedRun& run) { return observer->follow(run).drift_um; };
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
  list.push_back(baseline(kNoCorrection, s, [](const std::vector<Record>&, const Record& run) {
    return std::vector<double>(run.n_samples(), 0.0);
  }));
  list.push_back(baseline("mean of the training runs", s, [s](const std::vector<Record>& training, const Record& run) {
    return baseline_mean(training, run, s.target);
  }));
  list.push_back(baseline("last value of the training runs", s, [s](const std::vector<Record>& training, const Record& run) {
    return baseline_last(training, run, s.target);
  }));
  list.push_back(baseline("training runs at the same time", s, [s](const std::vector<Record>& training, const Record& run) {
    return baseline_same_time(training, run, s.target);
  }));
  const std::vector<Selector> by_records = selectors({.image = s.image});
  list.push_back(regression_on("one thermometer", s, by_record_selector(by_records.front().select, 1)));
  for (const Selector& selector : by_records)
    list.push_back(regression_on("regression, " + selector.name, s, by_record_selector(selector.select, s.n_sensors)));
  if (s.physics) {
    list.push_back(regression_on("regression, observability", s,
                                 [s](std::span<const ObservedRun> training, const std::vector<Record>&) {
                                   const Physics& p = *s.physics;
                                   return select_by_observability(p.system, p.start, training, s.candidates, s.target,
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
                      FittedFormula f = fit_from_speed(records_of(training, s), s.speed, s.hall, s.target);
                      return of_formula(std::move(f.model), std::move(f.reason), s);
                    }});
  }
  list.push_back({"thermometers and memories", false, [s](std::span<const ObservedRun> training) {
                    FittedFormula f = fit_with_memories(records_of(training, s), s.candidates, s.speed, s.hall, s.target);
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
std::vector<double> misses(const FittedStrategy& f, const ObservedRun& run, const StrategySettings& s) {
  const std::vector<double> predicted = f.predict(run);
  const Record& readings = s.count_from_start ? counted_from_start(run.readings, s.target) : run.readings;
  const std::vector<double>& measured = readings.at(s.target).values;
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

FittedStrategy fit_one(const Strategy& strategy, const StrategySettings& s, std::span<const ObservedRun> training) {
  FittedStrategy f = strategy.fit(training);
  f.name = strategy.name;
  f.is_baseline = strategy.is_baseline;
  f.interval_um = interval(strategy, s, training);
  if (f.is_baseline) return f;
  std::vector<std::vector<double>> predicted;
  for (const ObservedRun& run : training) predicted.push_back(f.predict(run));
  // an observer looks after its sensors itself
  std::vector<Record> readings;
  for (const ObservedRun& run : training) readings.push_back(run.readings);
  f.fail_safe =
      learn_fail_safe(readings, f.model ? f.model->inputs() : std::vector<std::string>{}, predicted, s.count_from_start);
  return f;
}

}  // namespace

GuardedCorrection FittedStrategy::correct(const ObservedRun& run) const {
  if (fail_safe) {
    const Repaired readings = repaired(*fail_safe, run.readings);
    return guarded(*fail_safe, readings, predict({run.cyclogram, run.hall, readings.readings}));
  }
  GuardedCorrection c{
      .correction_um = predict(run), .trust = std::vector<double>(run.readings.n_samples(), 1.0), .events = {}};
  for (double& v : c.correction_um) v = std::isfinite(v) ? v : 0.0;
  return c;
}

FittedStrategies fit_strategies(const StrategySettings& settings, std::span<const ObservedRun> training) {
  const std::vector<Strategy> list = strategies(settings);
  std::vector<std::optional<FittedStrategy>> fitted(list.size());
  std::vector<std::string> why(list.size());
  std::vector<std::exception_ptr> failures(list.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t i = 0; i < list.size(); ++i) {
    try {
      fitted[i] = fit_one(list[i], settings, training);
    } catch (const InputError& e) {
      why[i] = e.what();
    } catch (const SolveError& e) {  // a model that has no solution there
      why[i] = e.what();
    } catch (...) {
      failures[i] = std::current_exception();  // none may leave the parallel loop
    }
  }
  FittedStrategies result;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (failures[i]) std::rethrow_exception(failures[i]);
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

}  // namespace driftwright::app
