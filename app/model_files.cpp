#include "app/model_files.hpp"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/quantity.hpp"
#include "compensation/judging/judgement_json.hpp"
#include "compensation/predictors/observer.hpp"
#include "findings/strategy_section.hpp"
#include "follow/watch_json.hpp"
#include "follow/watch_trial.hpp"
#include "output/drift_model_c.hpp"
#include "output/linuxcnc_component.hpp"
#include "output/drift_model_files.hpp"
#include "output/predictor_file.hpp"

namespace driftwright::app {
namespace {

using namespace compensation;
using Json = nlohmann::ordered_json;

/// Limits by which `follow` watches an observer; null for others, and for an observer that no stream can feed.
Json watch_of(const JudgedStrategy& s, const StrategyMatrix& m, const Listener& listener) {
  const Observer* observer = s.fitted.predictor->observer();
  if (!observer || s.fitted.ambient.empty()) return nullptr;
  const std::optional<follow::WatchLimits> limits = follow::deployed_limits(*observer, m.training, listener);
  return limits ? follow::limits_json(*limits) : Json(nullptr);
}

/// The speeds and ambients that a driven predictor was fitted and judged on.
std::optional<output::Covered> covered_by(const JudgedStrategy& s, const StrategyMatrix& m) {
  if (!s.fitted.predictor->is_driven()) return std::nullopt;
  const double zero_degC = s.fitted.predictor->reference_K() - kZeroCelsius_K;
  output::Covered c{0.0, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  const auto take = [&](const MachineRun& run) {
    for (const auto& section : run.cyclogram.sections) c.most_rpm = std::max(c.most_rpm, section.drive.speed_rpm);
    for (double K : run.ambient.value) {
      c.low_degC = std::min(c.low_degC, K + zero_degC);
      c.high_degC = std::max(c.high_degC, K + zero_degC);
    }
  };
  for (const MachineRun& run : m.training) take(run);
  for (const JudgedRunOfMachine& r : m.runs) take(r.run);
  return c.high_degC >= c.low_degC ? std::optional(c) : std::nullopt;
}

output::ControlLanguage language_of(const std::string& as) {
  using Language = output::ControlLanguage;
  if (as == "st") return Language::kStructuredText;
  if (as == "siemens") return Language::kSiemens;
  if (as == "heidenhain") return Language::kHeidenhain;
  if (as == "fanuc") return Language::kFanuc;
  throw std::logic_error("no control's language: " + as);
}

}  // namespace

bool needs_control_files(const std::string& as) {
  return as == "c" || as == "linuxcnc";
}

std::vector<ControlFile> formula_files(const output::DeployedModel& formula, const std::string& as, const std::string& name,
                                       const output::ControlAxis& axis, const std::string& made_by) {
  if (as == "text") return {{name + ".txt", output::formula_text(formula)}};
  std::vector<ControlFile> files;
  if (needs_control_files(as)) files.push_back({name + ".c", output::c_function(formula, made_by)});
  if (as == "c") return files;
  if (as == "linuxcnc") {
    files.push_back({name + "_axis.comp", output::linuxcnc_component(formula, name + "_axis", name + ".c", made_by)});
    return files;
  }
  const output::ControlProgram program = output::control_program(formula, language_of(as), name, axis, made_by);
  return {{program.file, program.text}};
}

std::vector<ControlFile> travel_files(std::span<const output::PlacedModel> places, const std::string& as,
                                      const std::string& name, const output::ControlAxis& axis, const std::string& made_by) {
  if (as == "text") {
    std::string text = "One correction over the travel, straight between these places and held beyond them.\n";
    for (const output::PlacedModel& p : places)
      text += fmt::format("\nAt {:g} mm:\n{}", p.at_mm, output::formula_text(p.model));
    return {{name + ".txt", text}};
  }
  if (needs_control_files(as)) {
    std::vector<ControlFile> files = {{name + ".c", output::c_over_travel(places, name, made_by)}};
    if (as == "linuxcnc")
      files.push_back(
          {name + "_axis.comp", output::linuxcnc_over_travel(places, name, name + "_axis", name + ".c", made_by)});
    return files;
  }
  const output::ControlProgram program = output::control_program_over_travel(places, language_of(as), name, axis, made_by);
  return {{program.file, program.text}};
}

void write_models(const compensation::StrategyMatrix& m, output::ResultsFolder& folder, const Listener& listener) {
  const std::string own = findings::models_folder(m);
  bool has_formulas = false;
  for (const compensation::JudgedStrategy& s : m.strategies) {
    const std::string name = findings::model_file_name(s.fitted.name);
    folder.write_text(findings::model_file(m, s),
                      output::predictor_json({s.fitted, judgement_json(m, s), watch_of(s, m, listener), covered_by(s, m)},
                                             folder.made_by())
                              .dump(1) +
                          "\n");
    if (!s.fitted.predictor->formula() || !s.fitted.fail_safe) continue;
    const output::DeployedModel formula = output::deployed_model(s.fitted);
    const std::string made_by =
        fmt::format("Driftwright {}, scenario {}", folder.made_by().version, folder.made_by().scenario);
    for (const char* as : {"text", "linuxcnc"}) {  // the component comes with the C
      for (const ControlFile& file : formula_files(formula, as, name, {}, made_by))
        folder.write_text(own + file.name, file.text);
    }
    has_formulas = true;
  }
  for (const ControlFile& file : control_files()) {
    if (has_formulas) folder.write_text(own + file.name, file.text);
  }
}

}  // namespace driftwright::app
