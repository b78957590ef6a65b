#include "app/model_files.hpp"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "base/quantity.hpp"
#include "compensation/control/control_files.hpp"
#include "compensation/predictors/formula_predictor.hpp"
#include "findings/strategy_section.hpp"
#include "follow/watch_json.hpp"
#include "follow/watch_trial.hpp"
#include "output/document_json.hpp"
#include "output/drift_model_c.hpp"
#include "output/drift_model_files.hpp"
#include "output/predictor_file.hpp"

namespace driftwright::app {
namespace {

using namespace compensation;
using Json = nlohmann::ordered_json;

/// A strategy that is a formula, as text and C have it.
std::optional<output::DeployedModel> formula_of(const JudgedStrategy& s) {
  const DriftModel* model = as_formula(*s.fitted.predictor);
  if (!model || !s.fitted.fail_safe) return std::nullopt;
  return output::DeployedModel{*model, *s.fitted.fail_safe,
                               s.fitted.interval_um.value_or(std::numeric_limits<double>::quiet_NaN())};
}

/// Limits by which `follow` watches an observer; null for others, and for an observer that no stream can feed.
Json watch_of(const JudgedStrategy& s, const StrategyMatrix& m, const Listener& listener) {
  const auto* observer = dynamic_cast<const Observer*>(s.fitted.predictor.get());
  if (!observer || s.fitted.ambient.empty()) return nullptr;
  const std::optional<follow::WatchLimits> limits = follow::deployed_limits(*observer, m.training, listener);
  return limits ? follow::limits_json(*limits) : Json(nullptr);
}

/// The speeds and ambients that a driven predictor was fitted and judged on.
std::optional<output::Covered> covered_by(const JudgedStrategy& s, const StrategyMatrix& m) {
  if (!s.fitted.predictor->is_driven()) return std::nullopt;
  const double zero_degC = s.fitted.predictor->reference_K() - kZeroCelsius_K;
  output::Covered c{0.0, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  const auto take = [&](const ObservedRun& run) {
    for (const auto& section : run.cyclogram.sections) c.most_rpm = std::max(c.most_rpm, section.drive.speed_rpm);
    for (double K : run.ambient.value) {
      c.low_degC = std::min(c.low_degC, K + zero_degC);
      c.high_degC = std::max(c.high_degC, K + zero_degC);
    }
  };
  for (const ObservedRun& run : m.training) take(run);
  for (const JudgedRunOfMachine& r : m.runs) take(r.run);
  return c.high_degC >= c.low_degC ? std::optional(c) : std::nullopt;
}

}  // namespace

void write_models(const compensation::StrategyMatrix& m, const std::vector<effects::Effect>& effects,
                  output::ResultsFolder& folder, const Listener& listener) {
  const Json conditions = output::section_json(findings::conditions_of(m));
  bool has_formulas = false;
  for (const compensation::JudgedStrategy& s : m.strategies) {
    const std::string name = findings::model_file_name(s.fitted.name);
    Json judged = conditions;
    for (const compensation::JudgedRunOfMachine& r : m.runs)
      judged["judged_on"].push_back({{"run", r.name}, {"family", r.family}, {"season", r.season}});
    judged["with_failed_sensors"] = m.settings.fails_at.has_value();
    judged.update(output::section_json({.blocks = {findings::strategies_table(m, {&s})}})["strategies"][0]);
    folder.write_text(fmt::format("models/{}.json", name),
                      output::predictor_json({s.fitted, std::move(judged), watch_of(s, m, listener), covered_by(s, m)},
                                             effects, folder.made_by())
                              .dump(1) +
                          "\n");
    const std::optional<output::DeployedModel> formula = formula_of(s);
    if (!formula) continue;
    folder.write_text(fmt::format("models/{}.txt", name), output::formula_text(*formula));
    const std::string made_by =
        fmt::format("Driftwright {}, scenario {}", folder.made_by().version, folder.made_by().scenario);
    folder.write_text(fmt::format("models/{}.c", name), output::c_function(*formula, made_by));
    folder.write_text(fmt::format("models/{}_axis.comp", name),
                      output::linuxcnc_component(*formula, name + "_axis", name + ".c", made_by));
    has_formulas = true;
  }
  for (const ControlFile& file : control_files()) {
    if (has_formulas) folder.write_text("models/" + file.name, file.text);
  }
}

}  // namespace driftwright::app
