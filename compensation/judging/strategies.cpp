#include "compensation/judging/strategies.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "base/errors.hpp"
#include "base/lists.hpp"
#include "base/median.hpp"
#include "base/parallel.hpp"
#include "compensation/judging/choice.hpp"
#include "compensation/judging/folds.hpp"
#include "compensation/judging/left_out.hpp"
#include "compensation/predictors/blended_formula.hpp"
#include "compensation/predictors/fitted_formulas.hpp"
#include "compensation/predictors/formula_predictor.hpp"
#include "compensation/predictors/memory_regression.hpp"
#include "compensation/predictors/observability.hpp"
#include "compensation/predictors/past_drift.hpp"
#include "compensation/predictors/score.hpp"
#include "compensation/predictors/scored_rows.hpp"
#include "compensation/sensors/blocks.hpp"
#include "compensation/sensors/sensor_selection.hpp"
#include "solver/propagator.hpp"

namespace driftwright::compensation {
namespace {

using namespace compensation;

/// A strategy before it is fitted.
struct Strategy {
  std::string name;
  bool is_baseline = false;
  std::function<DeployedPredictor(std::span<const MachineRun>)> fit;
  bool is_blended = false;  ///< it takes part in the blend
};

/// One record per run.
std::vector<Record> records_of(std::span<const MachineRun> runs, const StrategySettings& s) {
  std::vector<Record> records;
  for (const MachineRun& run : runs) records.push_back(scored_readings(run, s.target, s.count_from_start));
  return records;
}

/// One record per history, for any number of runs cut from it: equal rows give an equal fit.
std::vector<Record> whole_records_of(std::span<const MachineRun> runs, const StrategySettings& s) {
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

/// The thermometers that a predictor depends on: those that it reads, and that of the ambient for a model of the machine.
std::vector<std::string> sensors_of(const Predictor& predictor, const StrategySettings& s) {
  std::vector<std::string> sensors = names_of(predictor.inputs());
  std::erase(sensors, s.speed);
  if (predictor.is_driven() && !s.ambient.empty() && !is_in(sensors, s.ambient)) sensors.push_back(s.ambient);
  return sensors;
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
  return {name, true, [s, make](std::span<const MachineRun> training) {
            std::vector<Record> records = records_of(training, s);
            for (std::size_t r = 0; r < records.size(); ++r)
              records[r] = own_rows(std::move(records[r]), training[r].n_before);
            return deployed(make(records), s);
          }};
}

/// A formula of channels.
/// @param members  of a mean: the formulas that it averages
DeployedPredictor of_formula(DriftModel model, std::string reason, const StrategySettings& s,
                             std::vector<DriftModel> members = {}) {
  model.from_start = s.count_from_start;
  DeployedPredictor d = deployed(std::make_shared<FormulaPredictor>(std::move(model), std::move(members)), s);
  d.sensors = sensors_of(*d.predictor, s);
  d.reason = std::move(reason);
  return d;
}

Strategy regression_on(const std::string& name, const StrategySettings& s,
                       std::function<Selection(std::span<const MachineRun>, const std::vector<Record>&)> select) {
  return {name, false, [s, select](std::span<const MachineRun> training) {
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
  return {name, false, [s, fit](std::span<const MachineRun> training) {
            require_thermometers(s);
            FittedFormula f = fit(in_blocks(whole_records_of(training, s), s.target), thermometers_of(s), s.target);
            return of_formula(std::move(f.model), std::move(f.reason), s);
          }};
}

Strategy remembering(const std::string& name, const StrategySettings& s, Columns columns, int n_modes = 0,
                     bool needs = true) {
  return {name, false,
          [s, columns, n_modes, needs](std::span<const MachineRun> training) {
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
std::vector<MachineRun> without_others_readings(std::vector<MachineRun> histories, const StrategySettings& s) {
  for (MachineRun& run : histories) {
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
  return {name, false, [s, with_sensors, learns](std::span<const MachineRun> training) {
            const Physics& p = *s.physics;
            const ObserverSettings how{.reading_K = s.reading_K, .drift_um = s.drift_um};
            const std::vector<MachineRun> histories = joined_histories(training, s.target);
            DeployedPredictor f;
            Selection selection;
            if (with_sensors) {
              selection = select_by_observability(p.system, p.start, histories, s.candidates, s.target, s.n_sensors, how);
              f.reason = fmt::format("{}: {}", fmt::join(selection.sensors, ", "), selection.reason);
            }
            Observer observer(p.system, p.start, p.start_ambient_K, learns ? s.candidates : selection.sensors, s.target, how,
                              p.laws);
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
            f.sensors = sensors_of(*f.predictor, s);
            return f;
          }};
}

std::vector<Strategy> strategies(const StrategySettings& s) {
  const auto by_record_selector = [&](decltype(Selector::select) select, int n) {
    return [s, select, n](std::span<const MachineRun>, const std::vector<Record>& records) {
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
    list.push_back(
        regression_on("regression, observability", s, [s](std::span<const MachineRun> training, const std::vector<Record>&) {
          const Physics& p = *s.physics;
          return select_by_observability(p.system, p.start, joined_histories(training, s.target), s.candidates, s.target,
                                         s.n_sensors, {.reading_K = s.reading_K});
        }));
  }
  list.push_back(formula_of_all("ridge, all sensors", s, fit_ridge));
  list.back().is_blended = true;
  list.push_back(formula_of_all("principal components, all sensors", s, fit_principal_components));
  list.push_back(formula_of_all("partial least squares, all sensors", s, fit_partial_least_squares));
  list.push_back({"regression with lags", false, [s](std::span<const MachineRun> training) {
                    require_thermometers(s);
                    const std::vector<Record> whole = whole_records_of(training, s), records = in_blocks(whole, s.target);
                    const Selection selection = select_forward(records, s.candidates, s.target, s.n_sensors);
                    FittedFormula f = fit_with_lags(records, selection.sensors, s.target, longest_lag_s(whole, s.target));
                    return of_formula(std::move(f.model),
                                      fmt::format("{}; {}", fmt::join(selection.sensors, ", "), f.reason), s);
                  }});
  if (!s.speed.empty()) {
    list.push_back({"transfer functions from speed", false, [s](std::span<const MachineRun> training) {
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

LeftOutSettings left_out_settings(const StrategySettings& s) {
  return {.target = s.target, .from_start = s.count_from_start, .limits = s.limits, .drift_um = s.drift_um};
}

/// Fits a strategy, without its errors on left-out rows and without fail-safe.
DeployedPredictor fit_one(const Strategy& strategy, const StrategySettings& s, std::span<const MachineRun> training) {
  DeployedPredictor f = strategy.fit(training);
  f.name = strategy.name;
  f.is_baseline = strategy.is_baseline;
  f.ambient = s.ambient;
  if (s.probing) f.probe.noise_um = s.probing->noise_um;
  return f;
}

/// The thermometers that the others contradict, in the rows of the runs alone: what lies before may belong to judged ones.
std::vector<DoubtedThermometer> doubted_in(std::span<const MachineRun> training, const StrategySettings& s) {
  std::vector<Record> records;
  for (const MachineRun& run : joined_histories(training, s.target)) {
    Record own = own_rows(run.readings, run.n_before);
    const std::vector<double> drift = own.at(s.target).values;
    if (!run.history.empty()) {  // rows between runs of one record
      for (Channel& c : own.channels) {
        for (std::size_t i = 0; i < drift.size(); ++i) c.values[i] = std::isfinite(drift[i]) ? c.values[i] : drift[i];
      }
    }
    records.push_back(std::move(own));
  }
  std::vector<std::string> thermometers = s.candidates, beside;
  std::erase(thermometers, s.ambient);
  for (const std::string& channel : {s.speed, s.ambient}) {
    if (!channel.empty()) beside.push_back(channel);
  }
  return doubted_thermometers(records, thermometers, beside, s.reading_K);
}

/// A strategy in each of the folds on which failed sensors are tried.
std::vector<FittedInFold> fitted_in_folds(const DeployedPredictor& fitted, const FoldPredictors& in_folds,
                                          const FoldedRuns& folds, const StrategySettings& s, double room) {
  std::vector<FittedInFold> list;
  if (in_folds.empty()) return list;
  for (std::size_t k : folds_for_failures(folds)) {
    DeployedPredictor& d = list.emplace_back(FittedInFold{k, fitted}).fitted;
    d.predictor = in_folds[k];
    d.sensors = sensors_of(*d.predictor, s);
    d.fail_safe = fail_safe_in_fold(*d.predictor, folds, k, left_out_settings(s), room);
  }
  return list;
}

/// A member of a blend.
struct Member {
  DeployedPredictor deployed;
  FoldPredictors in_folds;
};

/// The mean of the members whose error on left-out rows is about equal to the smallest; none if only one qualifies.
std::optional<DeployedPredictor> blend(std::vector<Member> members, const FoldedRuns& folds, const StrategySettings& s,
                                       std::span<const MachineRun> training) {
  double least = std::numeric_limits<double>::infinity();
  for (const Member& m : members) least = std::min(least, left_out_um(m.deployed));
  std::erase_if(members, [&](const Member& m) { return !(left_out_um(m.deployed) <= kAlike * least); });
  if (members.size() < 2) return std::nullopt;
  std::vector<DriftModel> models;
  std::vector<std::string> names;
  for (const Member& m : members) {
    models.push_back(*m.deployed.predictor->formula());
    names.push_back(m.deployed.name);
  }
  FoldPredictors in_folds;
  for (std::size_t k = 0; k < folds.folds.size(); ++k) {
    std::vector<DriftModel> of_fold;
    for (const Member& m : members) of_fold.push_back(*m.in_folds[k]->formula());
    in_folds.push_back(std::make_shared<FormulaPredictor>(mean_of(of_fold, kBlend)));
  }
  DeployedPredictor d =
      of_formula(mean_of(models, kBlend), fmt::format("the mean of {}", fmt::join(names, "; ")), s, models);
  d.name = kBlend;
  d.ambient = s.ambient;
  if (s.probing) d.probe.noise_um = s.probing->noise_um;
  const double room = set_left_out(d, in_folds, folds, left_out_settings(s));
  d.fail_safe = fail_safe_of(*d.predictor, training, left_out_settings(s), room);
  const auto has_residual = [](const Member& m) { return m.deployed.residual.has_value(); };
  if (d.residual && std::all_of(members.begin(), members.end(), has_residual)) {
    for (const Member& m : members) d.member_residuals.push_back({m.deployed.name, *m.deployed.residual});
  }
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

FittedStrategies fit_strategies(const StrategySettings& given, std::span<const MachineRun> training) {
  FittedStrategies result{.strategies = {}, .left_out = {}, .doubted = doubted_in(training, given)};
  StrategySettings settings = given;
  for (const DoubtedThermometer& d : result.doubted) {
    if (d.is_alone) std::erase(settings.candidates, d.name);
  }
  const std::vector<Strategy> list = strategies(settings);
  result.folds = folded(training, {.target = settings.target,
                                   .from_start = settings.count_from_start,
                                   .thermometers = thermometers_of(settings),
                                   .speed = settings.speed});
  const FoldedRuns& folds = result.folds;
  std::vector<std::optional<DeployedPredictor>> fitted(list.size());
  std::vector<FoldPredictors> in_folds(list.size());
  std::vector<std::vector<FittedInFold>> models_in_folds(list.size());
  std::vector<std::string> why(list.size());
  parallel_for(list.size(), [&](std::size_t i) {
    try {
      fitted[i] = fit_one(list[i], settings, training);
      in_folds[i] = fold_predictors([&](std::span<const MachineRun> rest) { return list[i].fit(rest).predictor; }, folds);
      const double room = set_left_out(*fitted[i], in_folds[i], folds, left_out_settings(settings));
      if (!fitted[i]->is_baseline)
        fitted[i]->fail_safe = fail_safe_of(*fitted[i]->predictor, training, left_out_settings(settings), room);
      if (fitted[i]->predictor->is_driven())
        models_in_folds[i] = fitted_in_folds(*fitted[i], in_folds[i], folds, settings, room);
    } catch (const InputError& e) {
      why[i] = e.what();
    } catch (const SolveError& e) {  // the model has no solution there
      why[i] = e.what();
    }
  });
  std::vector<Member> members;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!fitted[i]) {
      result.left_out.push_back({list[i].name, why[i]});
      continue;
    }
    if (list[i].is_blended && !in_folds[i].empty()) members.push_back({*fitted[i], in_folds[i]});
    result.strategies.push_back(std::move(*fitted[i]));
    result.in_folds.push_back(std::move(models_in_folds[i]));
  }
  try {
    if (std::optional<DeployedPredictor> mean = blend(members, folds, settings, training)) {
      result.strategies.push_back(std::move(*mean));
      result.in_folds.emplace_back();
    }
  } catch (const InputError& e) {  // no row has the inputs of all members
    result.left_out.push_back({kBlend, e.what()});
  }
  if (!settings.physics && !settings.without_physics.empty())
    result.left_out.push_back({"thermal modes, fitted model and observer", settings.without_physics});
  return result;
}

}  // namespace driftwright::compensation
