#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "app/compensate_frame.hpp"
#include "app/iso230_3_report.hpp"
#include "app/results.hpp"
#include "compensation/injector/axis_loop.hpp"
#include "compensation/judging/correction.hpp"
#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/formula_predictor.hpp"
#include "compensation/predictors/observer.hpp"
#include "machine/ways_out.hpp"
#include "output/html_report.hpp"
#include "output/json_text.hpp"
#include "output/json_value.hpp"
#include "output/predictor_file.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "scenarios/reader/record_part.hpp"
#include "studies/planner.hpp"
#include "studies/record_study.hpp"
#include "studies/thermal_modes.hpp"
#include "studies/validation_study.hpp"

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
  std::optional<double> margin_um = {};  ///< that the plan keeps, where there is one
};

/// The model's thermal modes, with laws of temperature frozen in the mean drive of the cyclogram that they are to foretell.
ModalPredictor modes_for(const Scenario& scenario, const scenarios::Model& model, const Cyclogram& cyclogram) {
  const Cyclogram felt = scenarios::felt_run(*scenario.machine, cyclogram).cyclogram;
  return scenarios::modal_predictors(scenario, model, scenario.study->thermal_modes, mean_drive({&felt})).completed;
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

/// What a predictor and its fail-safe read, a simulated machine must tell.
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
          fmt::format("{}: it reads '{}' in {}, which {} tells in {}", path, input.name, input.unit, scenario.path, unit));
  }
}

/// What it was judged to be, as its file says; "" where nobody has judged it.
std::string verdict_of(const Json& judged) {
  return judged.is_object() && judged.contains("verdict") && judged["verdict"].is_string()
             ? judged["verdict"].get<std::string>()
             : "";
}

/// A run that a predictor was fitted on says nothing of how good it is. @param is_fitted_on  of an entry of `trained_on`
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

/// A model follows a record only as `validate` would have let it.
void require_model_follows(const Scenario& scenario, const DeployedPredictor& d, const ObservedRun& run,
                           const std::string& hall) {
  if (!dynamic_cast<const Observer*>(d.predictor.get())) return;
  if (!scenario.machine)
    throw InputError(fmt::format("'{}' is a model of a machine, and {} has none", d.name, scenario.path));
  if (d.hall != hall)
    throw InputError(fmt::format("'{}' takes the hall from {}, which {} does not have", d.name,
                                 d.hall.empty() ? "the scenario" : "the channel '" + d.hall + "'", run.readings.source));
  if (const std::string why = studies::why_no_model_follows(*scenario.machine, run); !why.empty())
    throw InputError(fmt::format("'{}' cannot follow this record: {}", d.name, why));
}

/// --after FILE gives a whole record what came before it.
void require_continues(const Scenario& scenario, const CompensateOptions& options) {
  if (options.measured.empty()) throw InputError("--after goes with --measured, the record that continues it");
  if (scenario.study->count_from_start)
    throw InputError(scenario.study->where,
                     "drift counts from the start of each record (`count_from_start`), so that none continues another; "
                     "leave out --after");
  for (const std::string& record : {options.after, options.measured}) {
    if (!scenarios::read_record_part(record).is_whole())
      throw InputError(fmt::format("{}: --after is for whole records; a part goes on from its own record anyway", record));
  }
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
  compensation::Judgement j = compensation::judge(d, run, drift_um);
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
  const auto unknown = std::find_if(ahead_um.begin(), ahead_um.end(), [](double v) { return std::isnan(v); });
  if (unknown != ahead_um.end() && d.predictor->inputs().empty())
    throw InputError(fmt::format(
        "a schedule wants the drift of the whole run, and '{}' says nothing of it at {:.0f} min; take another --model",
        d.name, run.readings.time_s[static_cast<std::size_t>(unknown - ahead_um.begin())] / 60.0));
  if (unknown != ahead_um.end())
    throw InputError(fmt::format(
        "a schedule is written before the run, and '{}' has to read during it; take --through injector, or another --model",
        d.name));
  std::vector<double> durations_s;
  for (const auto& section : run.cyclogram.sections) durations_s.push_back(section.duration_s);
  const std::vector<double> boundaries_s = operation_boundaries_s(durations_s);
  const std::vector<double>& drift_um = run.readings.at(d.target).values;
  const double tolerance_um = scenario.study->tolerance_um,
               margin_um = std::min(d.interval_um.value_or(0.0), 0.5 * tolerance_um);
  const CorrectedRun corrected = correct_by_schedule({run.readings.time_s, drift_um, boundaries_s, tolerance_um}, ahead_um,
                                                     margin_um, studies::planner_of(scenario));
  return {.time_s = run.readings.time_s,
          .drift_um = drift_um,
          .predicted_um = ahead_um,
          .left_um = corrected.residual_um,
          .before = corrected.before,
          .after = corrected.after,
          .margin_um = margin_um};
}

/// The run's own rows, its time from 0, once all is judged.
void drop_lead_in(Outcome& o, std::size_t n_before) {
  if (n_before == 0) return;
  for (std::vector<double>* values : {&o.time_s, &o.drift_um, &o.predicted_um, &o.left_um})
    values->erase(values->begin(), values->begin() + static_cast<std::ptrdiff_t>(n_before));
  const double start_s = o.time_s.front();
  for (double& t_s : o.time_s) t_s -= start_s;
}

/// What ISO 230-3 asks of the drift, and of what is left of it.
Iso230Figures iso_figures(const Outcome& o, const ObservedRun& run, const std::string& channel) {
  if (run.n_before > 0)
    return {.running_period_s = 0.0, .channels = {}, .not_available = "the run goes on from what came before it"};
  Record test{.source = run.readings.source,
              .time_s = o.time_s,
              .channels = {{"speed", "rpm", {}}, {channel, "um", o.drift_um}, {channel + " corrected", "um", o.left_um}}};
  for (double t_s : o.time_s) test.channels.front().values.push_back(run.cyclogram.speed_rpm(t_s));
  return iso230_3_figures(test);
}

/// What verdict and margin of a live predictor do not say of a plan, a sentence each; none where nothing is planned.
std::vector<std::string> reservations_about(const DeployedPredictor& d, const Outcome& o, const std::string& verdict,
                                            double tolerance_um) {
  std::vector<std::string> sentences;
  if (!o.margin_um) return sentences;
  if (!verdict.empty())
    sentences.push_back(
        fmt::format("The verdict '{}' is of '{}' as it follows readings live; the plan, made before the run, was not judged "
                    "by `validate`.",
                    verdict, d.name));
  sentences.push_back(
      d.interval_um
          ? fmt::format(
                "The plan keeps a margin of {:.2f} um: the error of the live predictor on training runs (half of its "
                "95 % interval{}), not that of a prediction ahead.",
                *o.margin_um, *d.interval_um > 0.5 * tolerance_um ? ", cut to half of the tolerance" : "")
          : "The plan keeps no margin, for the predictor has no interval.");
  return sentences;
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
    (void)scenarios::require_machine(scenario, "compensate");
    return compensate_through_frame(scenario, options);
  }
  const scenarios::Study& study = scenarios::require_study(scenario, "compensate");
  const bool is_measured = !options.measured.empty();
  if (is_measured && (options.through != "none" || !options.cyclogram.empty() || options.model == "modes"))
    throw InputError(
        "--measured goes with --through none and a predictor's file, and without --cyclogram: a record says what happened");
  if (!options.after.empty()) require_continues(scenario, options);
  if (!is_measured) (void)scenarios::require_machine(scenario, "compensate");
  std::optional<DeployedPredictor> predictor;
  Json judged_as;
  if (options.model != "modes") {
    output::PredictorFile file = from_file(scenario, options.model);
    predictor = std::move(file.predictor);
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
  if (options.through == "injector") require_axis(scenario, predictor ? predictor->target : study.target);
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress;
  ObservedRun run;
  std::vector<double> ahead_um;
  if (is_measured) {
    RecordOptions measured;
    if (!options.after.empty()) measured.test.push_back(options.after);
    measured.test.push_back(options.measured);
    studies::StudyRecords records = studies::read_records(scenario, measured, &predictor->hall);
    for (const std::vector<std::string>* notes : {&records.notes, &records.findings}) {
      for (const std::string& note : *notes) fmt::print("note: {}\n", note);
    }
    run = std::move(records.test.back());
    if (!options.after.empty() && run.n_before == 0)
      throw InputError(
          fmt::format("{} does not continue {}: its times must begin within five rows of the other's end, with the same "
                      "channels in the same units",
                      options.measured, options.after));
    require_model_follows(scenario, *predictor, run, records.hall);
  } else {
    const scenarios::Model model = scenarios::open_model(scenario, {cyclogram}, progress.listener(), false);
    if (const scenarios::Machine* full = model.full())
      scenarios::require_ways_out(full->placed.mesh, full->placed.balance, scenario.machine->where);
    // a predictor knows what is recorded, as in validate_strategies(), and not what the scenario's effects make of it
    run = {*cyclogram, scenario.machine->hall,
           std::move(scenarios::simulate_cyclograms(scenario, model, {cyclogram}, progress.listener()).front().record)};
    if (options.through == "none" && predictor) {
      std::optional<Record> read;
      if (scenario.validation) read = studies::as_judged(*scenario.validation, cyclogram->name, run.readings);
      if (read) {
        fmt::print("note: thermometers read with noise and steps, as in this run of `validate`\n");
      } else {
        fmt::print("note: thermometers read exactly, for `validation` does not judge '{}' in the scenario's hall\n",
                   cyclogram->name);
      }
      if (read) run.readings = std::move(*read);
    }
    if (!predictor) {
      predictor = studies::by_thermal_modes(*scenario.machine, model.outputs(), modes_for(scenario, model, *cyclogram),
                                            study.target);
      predictor->name = fmt::format("{} thermal modes in the mean drive", study.thermal_modes);
    }
    if (options.through == "schedule") {
      // a formula reads temperatures that the modes foretell; anything else has drive and hall alone
      ObservedRun known{*cyclogram, run.hall, {.source = {}, .time_s = run.readings.time_s, .channels = {}}};
      if (as_formula(*predictor->predictor))
        known.readings = studies::foretold_record(*scenario.machine, model.outputs(), modes_for(scenario, model, *cyclogram),
                                                  *cyclogram, run.readings.time_s);
      ahead_um = ahead(*predictor->predictor, known);
    }
  }
  const DeployedPredictor& d = *predictor;
  progress.begin("correcting");
  run.readings.channels[static_cast<std::size_t>(&run.readings.at(d.target) - run.readings.channels.data())] =
      scored_readings(run, d.target, d.from_start).at(d.target);
  Outcome o = options.through == "none"       ? through_none(d, run)
              : options.through == "injector" ? through_injector(scenario, d, run)
                                              : through_schedule(scenario, d, run, ahead_um);
  drop_lead_in(o, run.n_before);
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
  const std::vector<std::string> reservations = reservations_about(d, o, verdict_of(judged_as), study.tolerance_um);
  if (o.margin_um) {
    summary["margin_um"] = *o.margin_um;
    summary["judged_as"] = "live";
  }
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
  for (const std::string& sentence : reservations) page.blocks.emplace_back(output::Paragraph{sentence});
  summary["iso_230_3"] = iso230_3_json(iso);
  page.blocks.push_back(iso230_3_block(iso));
  folder.write_text("corrected.csv",
                    corrected_csv(o, provenance_lines(folder.made_by(), (is_measured ? "record " : "cyclogram ") + what)));
  folder.write_text("summary.json", output::json_text(summary));
  folder.write_text("report.html", output::render_html(page));
  folder.commit();
  progress.end();
  if (const std::string verdict = verdict_of(judged_as); !verdict.empty()) fmt::print("judged by `validate`: {}\n", verdict);
  for (const std::string& sentence : reservations) fmt::print("{}\n", sentence);
  fmt::print(
      "{} by {} {}: peak {:.1f} um left of {:.1f} um ({:.0f} % removed), RMS {:.2f} of {:.2f} um\nreport in "
      "{}\n",
      d.target, d.name, way, o.after.peak_abs, o.before.peak_abs, removed, o.after.rmse, o.before.rmse,
      shown_path(folder.target() / "report.html"));
}

}  // namespace driftwright::app
