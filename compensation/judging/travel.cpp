#include "compensation/judging/travel.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "compensation/control/axis_travel.h"
#include "compensation/predictors/scored_rows.hpp"

namespace driftwright::compensation {
namespace {

/// The true drift of a run at each judged place, [place][row]; NaN where it is not known.
using DriftAlong = std::vector<std::vector<double>>;

/// Takes what is left of a run by corrections at some positions, [place][row], into account.
void take_run(LeftAlong& left, std::size_t run, const std::vector<TravelPlace>& places, const DriftAlong& drift_um,
              const std::vector<double>& at_m, const std::vector<std::vector<double>>& corrections_um) {
  left.peak_um.resize(places.size(), 0.0);
  std::vector<double> now_um(at_m.size());
  for (std::size_t row = 0; row < drift_um.front().size(); ++row) {
    for (std::size_t k = 0; k < at_m.size(); ++k) now_um[k] = corrections_um[k][row];
    for (std::size_t j = 0; j < places.size(); ++j) {
      const double correction_um =
          at_m.empty() ? 0.0 : axis_travel_value(at_m.data(), now_um.data(), static_cast<int>(at_m.size()), places[j].at_m);
      const double um = std::abs(drift_um[j][row] - correction_um);
      if (std::isnan(um)) continue;
      left.peak_um[j] = std::max(left.peak_um[j], um);
      if (um <= left.worst_um) continue;
      left.worst_um = um;
      left.place = j;
      left.run = run;
    }
  }
}

/// The strategy of this name for each place; empty if one of them has none.
std::vector<const JudgedStrategy*> at_all_places(std::span<const StrategyMatrix> corrected, const std::string& name) {
  std::vector<const JudgedStrategy*> found;
  for (const StrategyMatrix& m : corrected) {
    const auto at = std::find_if(m.strategies.begin(), m.strategies.end(),
                                 [&](const JudgedStrategy& s) { return s.fitted.name == name; });
    if (at == m.strategies.end()) return {};
    found.push_back(&*at);
  }
  return found;
}

/// A strategy with what it leaves on left-out parts at all places, as choose() compares it.
DeployedPredictor of_all_places(const std::vector<const JudgedStrategy*>& of_places) {
  DeployedPredictor d = of_places.front()->fitted;
  d.fold_errors.clear();
  for (const JudgedStrategy* of_place : of_places) {
    const std::vector<FoldError>& errors = of_place->fitted.fold_errors;
    if (errors.empty()) {
      d.fold_errors.clear();
      return d;
    }
    d.fold_errors.insert(d.fold_errors.end(), errors.begin(), errors.end());
    if (of_place->fitted.failed_um) d.failed_um = std::max(d.failed_um.value_or(0.0), *of_place->fitted.failed_um);
  }
  return d;
}

}  // namespace

Travel judge_travel(std::span<const StrategyMatrix> corrected, const std::vector<double>& at_m,
                    std::vector<TravelPlace> judged) {
  const std::vector<JudgedRunOfMachine>& runs = corrected.front().runs;
  Travel travel{.places = std::move(judged), .corrected_m = at_m, .uncorrected = {}, .strategies = {}};
  std::vector<DriftAlong> drift_um;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    drift_um.emplace_back();
    for (const TravelPlace& p : travel.places)
      drift_um.back().push_back(
          scored_readings(runs[r].run, p.channel, corrected.front().settings.strategies.count_from_start)
              .at(p.channel)
              .values);
    take_run(travel.uncorrected, r, travel.places, drift_um.back(), {}, {});
  }
  std::vector<std::vector<const JudgedStrategy*>> fitted;
  for (const JudgedStrategy& s : corrected.front().strategies) {
    if (s.fitted.is_baseline) continue;
    std::vector<const JudgedStrategy*> of_places = at_all_places(corrected, s.fitted.name);
    if (of_places.empty()) continue;
    TravelStrategy row{.name = s.fitted.name, .is_formula = true};
    for (const JudgedStrategy* of_place : of_places)
      row.is_formula = row.is_formula && of_place->fitted.predictor->formula() && of_place->fitted.fail_safe;
    row.alone.resize(at_m.size());
    travel.strategies.push_back(std::move(row));
    fitted.push_back(std::move(of_places));
  }
  parallel_for(fitted.size(), [&](std::size_t s) {
    TravelStrategy& row = travel.strategies[s];
    for (std::size_t r = 0; r < runs.size(); ++r) {
      std::vector<std::vector<double>> corrections_um;
      for (const JudgedStrategy* of_place : fitted[s])
        corrections_um.push_back(correct(of_place->fitted, runs[r].run).correction_um);
      for (std::size_t k = 0; k < at_m.size(); ++k)
        take_run(row.alone[k], r, travel.places, drift_um[r], {at_m[k]}, {corrections_um[k]});
      take_run(row.along, r, travel.places, drift_um[r], at_m, corrections_um);
    }
  });
  std::vector<DeployedPredictor> all, formulas;
  for (std::size_t s = 0; s < fitted.size(); ++s) {
    all.push_back(of_all_places(fitted[s]));
    if (travel.strategies[s].is_formula) formulas.push_back(all.back());
  }
  const auto index_of_name = [&](const std::string& name) -> std::optional<std::size_t> {
    for (std::size_t s = 0; s < all.size(); ++s) {
      if (all[s].name == name) return s;
    }
    return std::nullopt;
  };
  Choice choice = choose(all);
  travel.chosen = index_of_name(choice.name);
  travel.why_chosen = std::move(choice.why);
  travel.chosen_formula = index_of_name(choose(formulas).name);
  return travel;
}

}  // namespace driftwright::compensation
