#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/compensate_frame.hpp"
#include "app/results.hpp"
#include "app/validation_study.hpp"
#include "compensation/axis_loop.hpp"
#include "compensation/correction.hpp"
#include "compensation/interpolate.hpp"
#include "compensation/observability.hpp"
#include "output/drift_model_files.hpp"
#include "output/html_report.hpp"
#include "output/json_text.hpp"
#include "scenarios/as_recorded.hpp"
#include "scenarios/ways_out.hpp"

namespace driftwright::app {
namespace {

using namespace compensation;
using scenarios::Scenario;
using Json = nlohmann::ordered_json;

/// A predictor on its way to an actuator.
struct Source {
  std::string words;
  std::string channel;  ///< that it predicts
  Predictor live;       ///< from readings, as the run goes on
  /// Before the run; empty for one that has to read during it.
  std::vector<double> ahead_um;
  double margin_um = 0.0;  ///< half width of its 95 % interval
  bool from_start = false;
};

/// What the actuator left.
struct Outcome {
  std::vector<double> time_s = {}, drift_um = {}, predicted_um = {}, left_um = {};
  std::vector<bool> at_rest = {};  ///< rows that are judged, where the axis moves; empty: all
  Score before = {}, after = {};
};

Record modal_record(const Scenario& scenario, const Model& model, const Cyclogram& cyclogram,
                    const std::vector<double>& time_s) {
  const scenarios::FeltRun felt = scenarios::felt_run(*scenario.machine, cyclogram);
  const ModalPredictor predictor =
      modal_predictors(scenario, model, scenario.study->thermal_modes, mean_drive({&felt.cyclogram})).completed;
  return scenarios::as_recorded(*scenario.machine, predictor.predict(felt.cyclogram, felt.hall, time_s), model.outputs(),
                                cyclogram);
}

Source formula(const std::string& path, const Scenario& scenario, const Model& model, const Cyclogram& cyclogram,
               const Record& truth) {
  auto deployed = std::make_shared<output::DeployedModel>(output::read_model(path));
  Source s{.words = deployed->model.kind,
           .channel = deployed->model.target,
           .live = {},
           .ahead_um = {},
           .from_start = deployed->model.from_start};
  if (!truth.find(s.channel))
    throw InputError(fmt::format("{}: its target '{}' is no displacement of {}", path, s.channel, scenario.path));
  s.live = [deployed](const Record& readings) {
    const Repaired r = repaired(deployed->safe, readings);
    return guarded(deployed->safe, r, deployed->model.predict(r.readings)).correction_um;
  };
  // what may be known of the temperatures before the run is the model's prediction of them
  s.ahead_um = deployed->model.predict(modal_record(scenario, model, cyclogram, truth.time_s));
  s.margin_um = std::isfinite(deployed->interval_um) ? deployed->interval_um : 0.0;
  return s;
}

Source modes(const Scenario& scenario, const Model& model, const Cyclogram& cyclogram, const Record& truth) {
  Source s{.words = "thermal modes of the model", .channel = scenario.study->target, .live = {}, .ahead_um = {}};
  s.ahead_um = modal_record(scenario, model, cyclogram, truth.time_s).at(s.channel).values;
  s.live = [ahead = s.ahead_um, time_s = truth.time_s](const Record& readings) {
    std::vector<double> predicted;
    for (double t_s : readings.time_s) predicted.push_back(interpolate(time_s, ahead, t_s));
    return predicted;
  };
  return s;
}

Source observing(const Scenario& scenario, const Model& model, const Cyclogram& cyclogram, Progress& progress) {
  const scenarios::Study& study = *scenario.study;
  const double scatter = scenario.validation ? scenario.validation->model_scatter : scenarios::Validation{}.model_scatter;
  const std::optional<Physics> physics =
      physics_of(scenario, model, scatter, scenario.validation ? scenario.validation->seed : 1);
  if (!physics)
    throw InputError(
        scenario.machine->where,
        "an observer wants a linear reduced model: `solver: {model: reduced}`, and no law that follows temperatures");
  std::vector<const Cyclogram*> training;
  for (const std::string& name : study.train) training.push_back(&scenario.cyclogram(name));
  std::vector<ObservedRun> runs;
  for (SimulatedRun& run : simulate_cyclograms(scenario, model, training, progress, 0, nullptr)) {
    const scenarios::FeltRun felt = scenarios::felt_run(*scenario.machine, scenario.cyclogram(run.record.source));
    runs.push_back(
        {felt.cyclogram, felt.hall, as_read(std::move(run.record), {.resolution_K = study.sensor_resolution_K}, 1)});
  }
  progress.begin("teaching the observer");
  const std::vector<std::string> candidates = candidate_sensors(study, runs.front().readings);
  Observer all(physics->system, physics->start, physics->start_hall_K, candidates, study.target);
  all.learn(runs);
  const Selection selection =
      select_by_observability(physics->system, physics->start, runs, candidates, study.target, study.sensors_to_choose);
  auto observer = std::make_shared<Observer>(all.with_sensors(selection.sensors));
  const scenarios::FeltRun felt = scenarios::felt_run(*scenario.machine, cyclogram);
  Source s{.words = fmt::format("observer, {}", fmt::join(selection.sensors, ", ")),
           .channel = study.target,
           .live = {},
           .ahead_um = {},
           .from_start = true};
  s.live = [observer, felt](const Record& readings) {
    return observer->follow({felt.cyclogram, felt.hall, readings}).drift_um;
  };
  return s;
}

Outcome through_injector(const Scenario& scenario, const Source& source, const Record& truth) {
  if (!scenario.axis_loop) {
    throw InputError(
        scenario.study->where,
        "--through injector wants the block `axis_loop`, which says encoder, injector and servo (docs/injector.md)");
  }
  if (source.channel != scenario.axis_loop->displacement)
    throw InputError(scenario.axis_loop->where,
                     fmt::format("the axis corrects '{}', but the predictor tells '{}'; set `displacement: {}`, or take "
                                 "another --model",
                                 scenario.axis_loop->displacement, source.channel, source.channel));
  const AxisLoopRun run = run_axis_loop(scenario.axis_loop->loop, truth, source.channel, source.live);
  return {.time_s = run.time_s,
          .drift_um = run.before_um,
          .predicted_um = run.predicted_um,
          .left_um = run.after_um,
          .at_rest = run.at_rest};
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

Outcome through_schedule(const Scenario& scenario, const Source& source, const Record& truth, const Cyclogram& cyclogram) {
  if (source.ahead_um.empty())
    throw InputError(
        "a schedule is written before the run, and an observer reads during it; take --through injector, or another "
        "--model");
  std::vector<double> durations_s;
  for (const auto& section : cyclogram.sections) durations_s.push_back(section.duration_s);
  const std::vector<double> boundaries_s = operation_boundaries_s(durations_s);
  const CorrectedRun run =
      correct_by_schedule({truth.time_s, truth.at(source.channel).values, boundaries_s, scenario.study->tolerance_um},
                          source.ahead_um, source.margin_um);
  return {.time_s = truth.time_s,
          .drift_um = truth.at(source.channel).values,
          .predicted_um = source.ahead_um,
          .left_um = run.residual_um};
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
  (void)require_machine(scenario, "compensate");
  if (options.through == "frame") return compensate_through_frame(scenario, options);
  const scenarios::Study& study = require_study(scenario, "compensate");
  const Cyclogram& cyclogram = scenario.cyclogram(options.cyclogram.empty() ? study.judge : options.cyclogram);
  for (const std::string& name : study.train) {
    if (scenario.cyclogram(name).sections == cyclogram.sections)
      throw InputError(
          study.where,
          fmt::format("--cyclogram {}: it is what predictors are trained on ('{}'), and says nothing of how good they are",
                      cyclogram.name, name));
  }
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress;
  const Model model = open_model(scenario, {&cyclogram}, progress, false);
  if (const scenarios::Machine* full = model.full())
    scenarios::require_ways_out(full->placed.mesh, full->placed.balance, scenario.machine->where);
  Record truth = std::move(simulate_cyclograms(scenario, model, {&cyclogram}, progress, 0, nullptr).front().record);
  Source source = options.model == "modes"      ? modes(scenario, model, cyclogram, truth)
                  : options.model == "observer" ? observing(scenario, model, cyclogram, progress)
                                                : formula(options.model, scenario, model, cyclogram, truth);
  progress.begin("correcting");
  if (source.from_start) {
    const std::vector<double> counted =
        counted_from_start({.source = {}, .time_s = truth.time_s, .channels = {truth.at(source.channel)}}, source.channel)
            .channels.front()
            .values;
    truth.channels[static_cast<std::size_t>(&truth.at(source.channel) - truth.channels.data())].values = counted;
  }
  Outcome o = options.through == "injector" ? through_injector(scenario, source, truth)
                                            : through_schedule(scenario, source, truth, cyclogram);
  o.before = score(judged(o, o.drift_um));
  o.after = score(judged(o, o.left_um));
  const double removed = 100.0 * (1.0 - o.after.peak_abs / o.before.peak_abs);
  const std::string title = fmt::format("{}: {} corrected through the {}", scenario.name, source.channel, options.through);
  const Json summary = {
      {"program", "driftwright"},         {"version", folder.made_by().version}, {"scenario", folder.made_by().scenario},
      {"model", options.model},           {"predictor", source.words},           {"through", options.through},
      {"cyclogram", cyclogram.name},      {"channel", source.channel},           {"peak_before_um", o.before.peak_abs},
      {"peak_left_um", o.after.peak_abs}, {"removed_percent", removed},          {"rms_before_um", o.before.rmse},
      {"rms_left_um", o.after.rmse}};
  std::vector<double> t_min;
  for (double t_s : judged(o, o.time_s)) t_min.push_back(t_s / 60.0);
  output::Report page{.title = title,
                      .subtitle = fmt::format("Driftwright {}, scenario {}, cyclogram {}", folder.made_by().version,
                                              folder.made_by().scenario, cyclogram.name),
                      .blocks = {}};
  page.blocks.emplace_back(
      output::Verdict{o.after.peak_abs <= study.tolerance_um ? output::Verdict::Kind::kGood : output::Verdict::Kind::kBad,
                      fmt::format("{:.1f} um of {:.1f} um are left", o.after.peak_abs, o.before.peak_abs),
                      fmt::format("{}; tolerance {:g} um. RMS {:.2f} um instead of {:.2f} um.", source.words,
                                  study.tolerance_um, o.after.rmse, o.before.rmse)});
  page.blocks.emplace_back(
      output::Plot{.title = source.channel,
                   .x_label = "time [min]",
                   .y_label = source.channel + " [um]",
                   .series = {{.label = "without correction", .x = t_min, .y = judged(o, o.drift_um), .width = 3.0},
                              {.label = "predicted", .x = t_min, .y = judged(o, o.predicted_um)},
                              {.label = "left", .x = t_min, .y = judged(o, o.left_um)}},
                   .bands = {{.label = "tolerance", .low = -study.tolerance_um, .high = study.tolerance_um}}});
  folder.write_text("corrected.csv", corrected_csv(o, provenance_lines(folder.made_by(), "cyclogram " + cyclogram.name)));
  folder.write_text("summary.json", output::json_text(summary));
  folder.write_text("report.html", output::render_html(page));
  folder.commit();
  progress.end();
  fmt::print(
      "{} by {} through the {}: peak {:.1f} um left of {:.1f} um ({:.0f} % removed), RMS {:.2f} of {:.2f} um\nreport in "
      "{}\n",
      source.channel, source.words, options.through, o.after.peak_abs, o.before.peak_abs, removed, o.after.rmse,
      o.before.rmse, shown_path(folder.target() / "report.html"));
}

}  // namespace driftwright::app
