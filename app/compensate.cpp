#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/compensate_frame.hpp"
#include "app/iso230_3_report.hpp"
#include "app/planner.hpp"
#include "app/record_study.hpp"
#include "app/results.hpp"
#include "app/thermal_modes.hpp"
#include "app/validation_study.hpp"
#include "compensation/axis_loop.hpp"
#include "compensation/correction.hpp"
#include "compensation/formula_predictor.hpp"
#include "compensation/observer.hpp"
#include "output/html_report.hpp"
#include "output/json_text.hpp"
#include "output/predictor_file.hpp"
#include "scenarios/as_recorded.hpp"
#include "scenarios/ways_out.hpp"

namespace driftwright::app {
namespace {

using namespace compensation;
using scenarios::Scenario;
using Json = nlohmann::ordered_json;

/// What the actuator left.
struct Outcome {
  std::vector<double> time_s = {}, drift_um = {}, predicted_um = {}, left_um = {};
  std::vector<bool> at_rest = {};  ///< rows that are judged, where the axis moves; empty: all
  Score before = {}, after = {};
};

/// The model's thermal modes, with laws of temperature frozen in the mean drive of the cyclogram that they are to foretell.
ModalPredictor modes_for(const Scenario& scenario, const Model& model, const Cyclogram& cyclogram) {
  const Cyclogram felt = scenarios::felt_run(*scenario.machine, cyclogram).cyclogram;
  return modal_predictors(scenario, model, scenario.study->thermal_modes, mean_drive({&felt})).completed;
}

output::PredictorFile from_file(const Scenario& scenario, const std::string& path) {
  if (path == "observer") {
    throw InputError(
        "--model observer: an observer is fitted and judged by `validate`, which writes it to models/observer.json; take "
        "that file");
  }
  output::PredictorFile file = output::read_predictor(path);
  if (!scenario.machine) return file;
  const std::vector<scenarios::DisplacementOutput>& outputs = scenario.machine->displacements;
  const std::string& target = file.predictor.target;
  if (std::none_of(outputs.begin(), outputs.end(), [&](const auto& output) { return output.name == target; }))
    throw InputError(fmt::format("{}: its target '{}' is no displacement of {}", path, target, scenario.path));
  return file;
}

/// What it was judged to be, as its file says; "" where nobody has judged it.
std::string verdict_of(const Json& judged) {
  return judged.is_object() && judged.contains("verdict") && judged["verdict"].is_string()
             ? judged["verdict"].get<std::string>()
             : "";
}

/// A run that a predictor was fitted on says nothing of how good it is.
void refuse_trained_on(const Json& judged, const std::string& path, const std::string& run) {
  if (!judged.is_object() || !judged.contains("trained_on")) return;
  for (const Json& trained : judged["trained_on"]) {
    if (trained.is_string() && trained.get<std::string>() == run)
      throw InputError(
          fmt::format("{}: it was fitted on '{}', which says nothing of how good it is; take another run", path, run));
  }
}

/// A model follows a record only as `validate` would have let it.
void require_model_follows(const Scenario& scenario, const DeployedPredictor& d, const StudyRecords& records) {
  if (!dynamic_cast<const Observer*>(d.predictor.get())) return;
  const ObservedRun& run = records.test.front();
  if (!scenario.machine)
    throw InputError(fmt::format("'{}' is a model of a machine, and {} has none", d.name, scenario.path));
  if (d.hall != records.hall)
    throw InputError(fmt::format("'{}' takes the hall from {}, which {} does not have", d.name,
                                 d.hall.empty() ? "the scenario" : "the channel '" + d.hall + "'", run.readings.source));
  if (const std::string why = why_no_model_follows(*scenario.machine, run); !why.empty())
    throw InputError(fmt::format("'{}' cannot follow this record: {}", d.name, why));
}

/// What the injector wants, before any work.
void require_axis(const Scenario& scenario, const std::string& target) {
  if (!scenario.axis_loop) {
    throw InputError(
        scenario.study->where,
        "--through injector wants the block `axis_loop`, which says encoder, injector and servo (docs/injector.md)");
  }
  if (target != scenario.axis_loop->displacement)
    throw InputError(scenario.axis_loop->where,
                     fmt::format("the axis corrects '{}', but the predictor tells '{}'; set `displacement: {}`, or take "
                                 "another --model",
                                 scenario.axis_loop->displacement, target, target));
}

/// The values of rows that are judged: during a pass an axis lags behind its command, which is no thermal error.
std::vector<double> judged(const Outcome& o, const std::vector<double>& values) {
  if (o.at_rest.empty()) return values;
  std::vector<double> kept;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (o.at_rest[i]) kept.push_back(values[i]);
  }
  return kept;
}

/// The correction itself, as `validate` judges it.
Outcome through_none(const DeployedPredictor& d, const ObservedRun& run) {
  const std::vector<double>& drift_um = run.readings.at(d.target).values;
  Judgement j = judge(d, run, drift_um);
  return {.time_s = run.readings.time_s,
          .drift_um = drift_um,
          .predicted_um = std::move(j.correction_um),
          .left_um = std::move(j.left_um),
          .before = j.scores.before,
          .after = j.scores.after};
}

Outcome through_injector(const Scenario& scenario, const DeployedPredictor& d, const ObservedRun& run) {
  const AxisLoopRun loop = run_axis_loop(scenario.axis_loop->loop, run.readings, d.target, [&](const Record& readings) {
    return correct(d, {run.cyclogram, run.hall, readings}).correction_um;
  });
  Outcome o{.time_s = loop.time_s,
            .drift_um = loop.before_um,
            .predicted_um = loop.predicted_um,
            .left_um = loop.after_um,
            .at_rest = loop.at_rest};
  o.before = score(judged(o, o.drift_um));
  o.after = score(judged(o, o.left_um));
  return o;
}

Outcome through_schedule(const Scenario& scenario, const DeployedPredictor& d, const ObservedRun& run,
                         const std::vector<double>& ahead_um) {
  if (std::any_of(ahead_um.begin(), ahead_um.end(), [](double v) { return std::isnan(v); }))
    throw InputError(fmt::format(
        "a schedule is written before the run, and '{}' has to read during it; take --through injector, or another --model",
        d.name));
  std::vector<double> durations_s;
  for (const auto& section : run.cyclogram.sections) durations_s.push_back(section.duration_s);
  const std::vector<double> boundaries_s = operation_boundaries_s(durations_s);
  const std::vector<double>& drift_um = run.readings.at(d.target).values;
  const CorrectedRun corrected =
      correct_by_schedule({run.readings.time_s, drift_um, boundaries_s, scenario.study->tolerance_um}, ahead_um,
                          d.interval_um.value_or(0.0), planner_of(scenario));
  return {.time_s = run.readings.time_s,
          .drift_um = drift_um,
          .predicted_um = ahead_um,
          .left_um = corrected.residual_um,
          .before = corrected.before,
          .after = corrected.after};
}

/// What ISO 230-3 asks of the drift, and of what is left of it.
Iso230Figures iso_figures(const Outcome& o, const ObservedRun& run, const std::string& channel) {
  Record test{.source = run.readings.source,
              .time_s = o.time_s,
              .channels = {{"speed", "rpm", {}}, {channel, "um", o.drift_um}, {channel + " corrected", "um", o.left_um}}};
  for (double t_s : o.time_s) test.channels.front().values.push_back(run.cyclogram.speed_rpm(t_s));
  return iso230_3_figures(test);
}

std::string corrected_csv(const Outcome& o, const std::vector<std::string>& comments) {
  std::string csv;
  for (const std::string& c : comments) csv += "# " + c + "\n";
  csv += fmt::format("time_s,drift_um,predicted_um,left_um{}\n", o.at_rest.empty() ? "" : ",at_rest");
  for (std::size_t i = 0; i < o.time_s.size(); ++i) {
    csv += fmt::format("{:.7g},{:.7g},{:.7g},{:.7g}", o.time_s[i], o.drift_um[i], o.predicted_um[i], o.left_um[i]);
    csv += o.at_rest.empty() ? "\n" : o.at_rest[i] ? ",1\n" : ",0\n";
  }
  return csv;
}

}  // namespace

void compensate(const CompensateOptions& options) {
  const Scenario scenario = scenarios::read_scenario(options.scenario);
  if (options.through == "frame") {
    (void)require_machine(scenario, "compensate");
    return compensate_through_frame(scenario, options);
  }
  const scenarios::Study& study = require_study(scenario, "compensate");
  const bool is_measured = !options.measured.empty();
  if (is_measured && (options.through != "none" || !options.cyclogram.empty() || options.model == "modes"))
    throw InputError(
        "--measured goes with --through none and a predictor's file, and without --cyclogram: a record says what happened");
  if (!is_measured) (void)require_machine(scenario, "compensate");
  std::optional<DeployedPredictor> predictor;
  Json judged_as;
  if (options.model != "modes") {
    output::PredictorFile file = from_file(scenario, options.model);
    predictor = std::move(file.predictor);
    judged_as = std::move(file.judged);
  }
  const Cyclogram* cyclogram = nullptr;
  if (!is_measured) cyclogram = &scenario.cyclogram(options.cyclogram.empty() ? study.judge : options.cyclogram);
  refuse_trained_on(judged_as, options.model, is_measured ? options.measured : cyclogram->name);
  if (options.through == "injector") require_axis(scenario, predictor ? predictor->target : study.target);
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress;
  ObservedRun run;
  std::vector<double> ahead_um;
  if (is_measured) {
    RecordOptions measured;
    measured.test = {options.measured};
    StudyRecords records = read_records(scenario, measured, &predictor->hall);
    for (const std::vector<std::string>* notes : {&records.notes, &records.findings}) {
      for (const std::string& note : *notes) fmt::print("note: {}\n", note);
    }
    require_model_follows(scenario, *predictor, records);
    run = std::move(records.test.front());
  } else {
    const Model model = open_model(scenario, {cyclogram}, progress, false);
    if (const scenarios::Machine* full = model.full())
      scenarios::require_ways_out(full->placed.mesh, full->placed.balance, scenario.machine->where);
    // a predictor knows what is recorded, as in validate_strategies(), and not what the scenario's effects make of it
    run = {*cyclogram, scenario.machine->hall,
           std::move(simulate_cyclograms(scenario, model, {cyclogram}, progress, 0, nullptr).front().record)};
    if (!predictor) {
      predictor = by_thermal_modes(*scenario.machine, model.outputs(), modes_for(scenario, model, *cyclogram), study.target);
      predictor->name = "thermal modes of the model";
    }
    if (options.through == "schedule") {
      // a formula reads temperatures that the modes foretell; anything else has drive and hall alone
      ObservedRun known{*cyclogram, run.hall, {.source = {}, .time_s = run.readings.time_s, .channels = {}}};
      if (as_formula(*predictor->predictor))
        known.readings = foretold_record(*scenario.machine, model.outputs(), modes_for(scenario, model, *cyclogram),
                                         *cyclogram, run.readings.time_s);
      ahead_um = ahead(*predictor->predictor, known);
    }
  }
  const DeployedPredictor& d = *predictor;
  progress.begin("correcting");
  run.readings.channels[static_cast<std::size_t>(&run.readings.at(d.target) - run.readings.channels.data())] =
      scored_readings(run, d.target, d.from_start).at(d.target);
  const Outcome o = options.through == "none"       ? through_none(d, run)
                    : options.through == "injector" ? through_injector(scenario, d, run)
                                                    : through_schedule(scenario, d, run, ahead_um);
  const std::string what = is_measured ? run.readings.source : cyclogram->name;
  const double removed = 100.0 * (1.0 - o.after.peak_abs / o.before.peak_abs);
  const std::string way = options.through == "none" ? "without an actuator" : "through the " + options.through;
  const std::string title = fmt::format("{}: {} corrected {}", scenario.name, d.target, way);
  const Iso230Figures iso = iso_figures(o, run, d.target);
  Json summary = {{"program", "driftwright"},
                  {"version", folder.made_by().version},
                  {"scenario", folder.made_by().scenario},
                  {"model", options.model},
                  {"judged", verdict_of(judged_as)},
                  {"predictor", d.name},
                  {"through", options.through},
                  {"cyclogram", what},
                  {"channel", d.target},
                  {"peak_before_um", o.before.peak_abs},
                  {"peak_left_um", o.after.peak_abs},
                  {"removed_percent", removed},
                  {"rms_before_um", o.before.rmse},
                  {"rms_left_um", o.after.rmse}};
  std::vector<double> t_min;
  for (double t_s : judged(o, o.time_s)) t_min.push_back(t_s / 60.0);
  output::Report page{.title = title,
                      .subtitle = fmt::format("Driftwright {}, scenario {}, cyclogram {}", folder.made_by().version,
                                              folder.made_by().scenario, what),
                      .blocks = {}};
  page.blocks.emplace_back(
      output::Verdict{o.after.peak_abs <= study.tolerance_um ? output::Verdict::Kind::kGood : output::Verdict::Kind::kBad,
                      fmt::format("{:.1f} um of {:.1f} um are left", o.after.peak_abs, o.before.peak_abs),
                      fmt::format("{}; tolerance {:g} um. RMS {:.2f} um instead of {:.2f} um.", d.name, study.tolerance_um,
                                  o.after.rmse, o.before.rmse)});
  page.blocks.emplace_back(
      output::Plot{.title = d.target,
                   .x_label = "time [min]",
                   .y_label = d.target + " [um]",
                   .series = {{.label = "without correction", .x = t_min, .y = judged(o, o.drift_um), .width = 3.0},
                              {.label = "predicted", .x = t_min, .y = judged(o, o.predicted_um)},
                              {.label = "left", .x = t_min, .y = judged(o, o.left_um)}},
                   .bands = {{.label = "tolerance", .low = -study.tolerance_um, .high = study.tolerance_um}}});
  summary["iso_230_3"] = iso230_3_json(iso);
  page.blocks.push_back(iso230_3_block(iso));
  folder.write_text("corrected.csv",
                    corrected_csv(o, provenance_lines(folder.made_by(), (is_measured ? "record " : "cyclogram ") + what)));
  folder.write_text("summary.json", output::json_text(summary));
  folder.write_text("report.html", output::render_html(page));
  folder.commit();
  progress.end();
  if (const std::string verdict = verdict_of(judged_as); !verdict.empty()) fmt::print("judged by `validate`: {}\n", verdict);
  fmt::print(
      "{} by {} {}: peak {:.1f} um left of {:.1f} um ({:.0f} % removed), RMS {:.2f} of {:.2f} um\nreport in "
      "{}\n",
      d.target, d.name, way, o.after.peak_abs, o.before.peak_abs, removed, o.after.rmse, o.before.rmse,
      shown_path(folder.target() / "report.html"));
}

}  // namespace driftwright::app
