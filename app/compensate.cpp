#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "app/machine_predictor.hpp"
#include "app/results.hpp"
#include "base/option_quantity.hpp"
#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/observer.hpp"
#include "findings/correction_document.hpp"
#include "findings/frame_document.hpp"
#include "output/json_value.hpp"
#include "output/predictor_file.hpp"
#include "scenarios/reader/record_part.hpp"
#include "studies/correction_study.hpp"
#include "studies/frame_study.hpp"

namespace driftwright::app {
namespace {

using namespace compensation;
using scenarios::Scenario;
using Json = nlohmann::ordered_json;

output::PredictorFile from_file(const Scenario& scenario, const std::string& path) {
  if (path == "observer") {
    throw InputError(
        "--model observer: an observer is fitted and judged by `validate`, which writes it to models/observer.json; take "
        "that file");
  }
  return read_machine_predictor(scenario, path);
}

/// Requires that the simulated machine has all inputs of a predictor and its fail-safe.
void require_inputs(const Scenario& scenario, const DeployedPredictor& d, const std::string& path) {
  const scenarios::MachineModel& machine = *scenario.machine;
  std::vector<Input> wanted = d.predictor->inputs();
  if (d.fail_safe) {
    for (const FailSafe::Guard& g : d.fail_safe->guards) wanted.push_back({g.input, g.unit});
  }
  for (const Input& input : wanted) {
    const bool is_temperature = std::any_of(machine.sensors.begin(), machine.sensors.end(),
                                            [&](const scenarios::Sensor& s) { return s.name == input.name; }) ||
                                (input.name == scenarios::kAmbient && scenarios::has_ambient_channel(machine));
    if (!is_temperature && input.name != "speed" && !is_drive(input.unit))
      throw InputError(
          fmt::format("{}: it reads '{}', which is no sensor of {} and not its `speed`; take a predictor that "
                      "`validate` has fitted to this machine",
                      path, input.name, scenario.path));
    const std::string unit = is_temperature ? "degC" : input.name == "speed" ? "rpm" : input.unit;
    if (input.unit != unit)
      throw InputError(
          fmt::format("{}: it reads '{}' in {}, but {} gives it in {}", path, input.name, input.unit, scenario.path, unit));
  }
}

/// The verdict in the predictor's file; "" if nothing has judged it.
std::string verdict_of(const Json& judged) {
  return judged.is_object() && judged.contains("verdict") && judged["verdict"].is_string()
             ? judged["verdict"].get<std::string>()
             : "";
}

/// A predictor must not be judged by a run that it was fitted on. @param is_fitted_on  says whether an entry of
/// `trained_on` is that run
void refuse_trained_on(const Json& judged, const std::string& path, const std::string& run,
                       const std::function<bool(const Json&)>& is_fitted_on) {
  if (!judged.is_object() || !judged.contains("trained_on") || !judged["trained_on"].is_array()) return;
  for (const Json& trained : judged["trained_on"]) {
    if (is_fitted_on(trained))
      throw InputError(
          fmt::format("{}: it was fitted on rows of '{}', which says nothing of how good it is; take another run or part of "
                      "a record",
                      path, run));
  }
}
void refuse_trained_on_cyclogram(const Json& judged, const std::string& path, const std::string& cyclogram) {
  refuse_trained_on(judged, path, cyclogram,
                    [&](const Json& trained) { return trained.is_string() && trained.get<std::string>() == cyclogram; });
}
void refuse_trained_on_record(const Json& judged, const std::string& path, const std::string& record) {
  const scenarios::RecordPart part = scenarios::read_record_part(record);
  refuse_trained_on(judged, path, record, [&](const Json& trained) {
    return trained.is_object() &&
           scenarios::has_rows_of(part, output::value<std::string>(trained, "file"), output::finite(trained, "from_s"),
                                  output::finite(trained, "until_s"));
  });
}

/// With --after FILE, `measured` must continue that record.
void require_continues(const Scenario& scenario, const CompensateOptions& options) {
  if (scenario.study->count_from_start)
    throw InputError(scenario.study->where,
                     "drift counts from the start of each record (`count_from_start`), so that none continues another; "
                     "leave out --after");
  for (const std::string& record : {options.after, options.measured}) {
    if (!scenarios::read_record_part(record).is_whole())
      throw InputError(fmt::format("{}: --after is for whole records; a part goes on from its own record anyway", record));
  }
}

/// Requires what the injector needs, before any work.
void require_axis(const Scenario& scenario, const std::string& target) {
  if (!scenario.axis_loop) {
    throw InputError(scenario.study->where,
                     "--through injector requires the block `axis_loop`, which describes encoder, injector and servo "
                     "(docs/how-to/injector.md)");
  }
  if (target != scenario.axis_loop->displacement)
    throw InputError(
        scenario.axis_loop->where,
        fmt::format("the axis corrects '{}', but the predictor gives '{}'; set `displacement: {}`, or take another --model",
                    scenario.axis_loop->displacement, target, target));
}

/// The time between probings; none: not probed. @param d  gets the noise of the probe
std::optional<double> probings_of(const CompensateOptions& options, DeployedPredictor* d) {
  if (options.probe.empty()) return std::nullopt;
  if (!d || !d->residual)
    throw InputError(fmt::format(
        "--probe: {} does not say what its strategy leaves (key `probing` is null or missing); `validate` writes it "
        "where parts of the training runs could be left out",
        options.model));
  const double every_s = option_quantity("--probe", options.probe, "s");
  if (!options.probe_noise.empty()) d->probe.noise_um = option_quantity("--probe-noise", options.probe_noise, "um");
  if (!(every_s > 0.0) || !(d->probe.noise_um > 0.0))
    throw InputError(fmt::format("--probe '{}' and --probe-noise '{}' must be above 0", options.probe, options.probe_noise));
  return every_s;
}

std::string corrected_csv(const studies::CorrectionStudy& o, const std::vector<std::string>& comments) {
  std::string csv;
  for (const std::string& c : comments) csv += "# " + c + "\n";
  csv += fmt::format("time_s,drift_um,predicted_um,left_um{}{}\n", o.at_rest.empty() ? "" : ",at_rest",
                     o.probed ? ",left_probed_um" : "");
  for (std::size_t i = 0; i < o.time_s.size(); ++i) {
    csv += fmt::format("{:.7g},{:.7g},{:.7g},{:.7g}", o.time_s[i], o.drift_um[i], o.predicted_um[i], o.left_um[i]);
    csv += o.at_rest.empty() ? "" : o.at_rest[i] ? ",1" : ",0";
    csv += o.probed ? fmt::format(",{:.7g}\n", o.probed->left_um[i]) : "\n";
  }
  return csv;
}

/// corrected.csv: the largest error on the table over time, for each correction.
std::string frame_csv(const studies::FrameStudy& study) {
  std::string csv = "time_s";
  for (const studies::TableStrategy& row : study.corrections) csv += fmt::format(",\"{}_um\"", row.name);
  csv += "\n";
  for (std::size_t i = 0; i < study.time_s.size(); ++i) {
    csv += fmt::format("{:.7g}", study.time_s[i]);
    for (const studies::TableStrategy& row : study.corrections) csv += fmt::format(",{:.7g}", row.course_um[i]);
    csv += "\n";
  }
  return csv;
}

void compensate_through_frame(const Scenario& scenario, const CompensateOptions& options) {
  if (!scenario.table)
    throw InputError(scenario.machine->where, "--through frame requires the block `table` (docs/how-to/table.md)");
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  const studies::FrameStudy study = studies::correct_through_frame(scenario, options.model, progress.listener());
  folder.write_text("corrected.csv", frame_csv(study));
  finish(findings::document_of(study, scenario, options.model, folder.made_by()), folder, progress, options);
}

/// Checks the options before anything is read.
void require_options_that_go_together(const CompensateOptions& options) {
  const bool is_measured = !options.measured.empty(), through_frame = options.through == "frame";
  if (is_measured && (options.through != "none" || !options.cyclogram.empty() || options.model == "modes"))
    throw InputError(
        "--measured is allowed only with --through none and a predictor's file, and without --cyclogram: a record says what "
        "happened");
  if (!options.after.empty() && !is_measured) throw InputError("--after requires --measured, the record that continues it");
  if (!options.probe.empty() && (options.through != "none" || options.model == "modes"))
    throw InputError(
        "--probe is allowed only with --through none and a predictor's file: a plan is written before the run and knows no "
        "probing, the injector is simulated without one, and the words of --model have no file that says how their errors "
        "fade");
  const auto& frame_models = studies::kFrameModels;
  if (through_frame && std::find(frame_models.begin(), frame_models.end(), options.model) == frame_models.end())
    throw InputError(
        fmt::format("--model {}: --through frame allows only {}; a table has six errors and more, and a model.json one",
                    options.model, fmt::join(frame_models, ", ")));
}

}  // namespace

void compensate(const CompensateOptions& options) {
  require_options_that_go_together(options);
  const Scenario scenario = read_scenario(options);
  if (options.through == "frame") {
    (void)scenarios::require_machine(scenario, "compensate");
    return compensate_through_frame(scenario, options);
  }
  const scenarios::Study& study = scenarios::require_study(scenario, "compensate");
  const bool is_measured = !options.measured.empty();
  if (!options.after.empty()) require_continues(scenario, options);
  if (!is_measured) (void)scenarios::require_machine(scenario, "compensate");
  std::optional<DeployedPredictor> predictor;
  Json judged_as;
  if (options.model != "modes") {
    output::PredictorFile file = from_file(scenario, options.model);
    predictor = std::move(file.predictor);
    if (predictor->fail_safe) limit(*predictor->fail_safe, scenario.limits.correction);
    judged_as = std::move(file.judged);
  }
  const Cyclogram* cyclogram = nullptr;
  if (!is_measured) cyclogram = &scenario.cyclogram(options.cyclogram.empty() ? study.judge : options.cyclogram);
  if (is_measured) {
    refuse_trained_on_record(judged_as, options.model, options.measured);
  } else {
    refuse_trained_on_cyclogram(judged_as, options.model, cyclogram->name);
  }
  if (predictor && !is_measured) require_inputs(scenario, *predictor, options.model);
  const std::optional<double> probed_every_s = probings_of(options, predictor ? &*predictor : nullptr);
  if (options.through == "injector") require_axis(scenario, predictor ? predictor->target : study.target);
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  const studies::CorrectionStudy corrected = studies::correct_run(scenario, std::move(predictor),
                                                                  {.through = options.through,
                                                                   .cyclogram = cyclogram,
                                                                   .measured = options.measured,
                                                                   .after = options.after,
                                                                   .probed_every_s = probed_every_s},
                                                                  progress.listener());
  folder.write_text("corrected.csv",
                    corrected_csv(corrected, provenance_lines(folder.made_by(),
                                                              (is_measured ? "record " : "cyclogram ") + corrected.run)));
  finish(findings::document_of(corrected, scenario,
                               {.model = options.model, .verdict = verdict_of(judged_as), .through = options.through},
                               folder.made_by()),
         folder, progress, options);
}

}  // namespace driftwright::app
