#include "studies/correction_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/record_channel.hpp"
#include "compensation/injector/axis_loop.hpp"
#include "compensation/judging/correction.hpp"
#include "compensation/predictors/formula_predictor.hpp"
#include "compensation/predictors/observer.hpp"
#include "compensation/predictors/scored_rows.hpp"
#include "machine/simulated_run.hpp"
#include "machine/ways_out.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "studies/planner.hpp"
#include "studies/record_study.hpp"
#include "studies/thermal_modes.hpp"
#include "studies/validation_study.hpp"

namespace driftwright::studies {

using namespace compensation;
using scenarios::Scenario;

std::vector<double> judged_rows(const CorrectionStudy& o, const std::vector<double>& values) {
  if (o.at_rest.empty()) return values;
  std::vector<double> kept;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (o.at_rest[i]) kept.push_back(values[i]);
  }
  return kept;
}

namespace {

/// The model's thermal modes, with laws of temperature frozen at the mean drive of the cyclogram to predict.
ModalPredictor modes_for(const Scenario& scenario, const scenarios::Model& model, const Cyclogram& cyclogram) {
  const Cyclogram felt = scenarios::felt_run(*scenario.machine, cyclogram).cyclogram;
  return scenarios::modal_predictors(scenario, model, scenario.study->thermal_modes, mean_drive({&felt})).completed;
}

/// Requires what `validate` requires before a model follows a record.
void require_model_follows(const Scenario& scenario, const DeployedPredictor& d, const MachineRun& run,
                           const std::string& ambient) {
  if (!d.predictor->is_driven()) return;
  if (!scenario.machine)
    throw InputError(fmt::format("'{}' is a model of a machine, and {} has none", d.name, scenario.path));
  if (d.ambient != ambient)
    throw InputError(fmt::format("'{}' takes the ambient from {}, which {} does not have", d.name,
                                 d.ambient.empty() ? "the scenario" : "the channel '" + d.ambient + "'",
                                 run.readings.source));
  if (const std::string why = why_no_model_follows(*scenario.machine, run); !why.empty())
    throw InputError(fmt::format("'{}' cannot follow this record: {}", d.name, why));
}

/// The correction without an actuator, as `validate` judges it.
CorrectionStudy through_none(const DeployedPredictor& d, const MachineRun& run,
                             const std::optional<double>& probed_every_s) {
  const std::vector<double>& drift_um = run.readings.at(d.target).values;
  compensation::Judgement j = compensation::judge(d, run, drift_um);
  std::optional<ProbedRun> probed;
  if (probed_every_s)
    probed = probed_run(probed_members(d, j), run.readings.time_s,
                        {.every_s = *probed_every_s, .noise_um = d.probe.noise_um, .keeps_rows = true});
  return {.time_s = run.readings.time_s,
          .drift_um = drift_um,
          .predicted_um = std::move(j.correction_um),
          .left_um = std::move(j.left_um),
          .before = j.scores.before,
          .after = j.scores.after,
          .probed = std::move(probed)};
}

CorrectionStudy through_injector(const Scenario& scenario, const DeployedPredictor& d, const MachineRun& run) {
  const AxisLoopResult loop = run_axis_loop(scenario.axis_loop->loop, run.readings, d.target, [&](const Record& readings) {
    return correct(d, {run.cyclogram, run.ambient, readings}).correction_um;
  });
  CorrectionStudy o{.time_s = loop.time_s,
                    .drift_um = loop.before_um,
                    .predicted_um = loop.predicted_um,
                    .left_um = loop.after_um,
                    .at_rest = loop.at_rest};
  o.before = score(judged_rows(o, o.drift_um));
  o.after = score(judged_rows(o, o.left_um));
  return o;
}

CorrectionStudy through_schedule(const Scenario& scenario, const DeployedPredictor& d, const MachineRun& run,
                                 const std::vector<double>& ahead_um) {
  const auto unknown = std::find_if(ahead_um.begin(), ahead_um.end(), [](double v) { return std::isnan(v); });
  if (unknown != ahead_um.end() && d.predictor->inputs().empty())
    throw InputError(fmt::format(
        "a schedule requires the drift of the whole run, and '{}' says nothing of it at {:.0f} min; take another --model",
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
  const CorrectedDrift corrected = correct_by_schedule({run.readings.time_s, drift_um, boundaries_s, tolerance_um}, ahead_um,
                                                       margin_um, planner_of(scenario), scenario.limits.correction);
  return {.time_s = run.readings.time_s,
          .drift_um = drift_um,
          .predicted_um = ahead_um,
          .left_um = corrected.residual_um,
          .before = corrected.before,
          .after = corrected.after,
          .margin_um = margin_um};
}

/// Drops the rows before the run, and counts its time from 0, once everything is judged.
void drop_lead_in(CorrectionStudy& o, std::size_t n_before) {
  if (n_before == 0) return;
  for (std::vector<double>* values : {&o.time_s, &o.drift_um, &o.predicted_um, &o.left_um})
    values->erase(values->begin(), values->begin() + static_cast<std::ptrdiff_t>(n_before));
  if (o.probed)
    o.probed->left_um.erase(o.probed->left_um.begin(), o.probed->left_um.begin() + static_cast<std::ptrdiff_t>(n_before));
  const double start_s = o.time_s.front();
  for (double& t_s : o.time_s) t_s -= start_s;
}

/// The figures of ISO 230-3 for the drift, and for the drift that is left.
Iso230Figures iso_figures(const CorrectionStudy& o, const MachineRun& run, const std::string& channel) {
  if (run.n_before > 0)
    return {.running_period_s = 0.0, .channels = {}, .not_available = "the run goes on from what came before it"};
  Record test{.source = run.readings.source,
              .time_s = o.time_s,
              .channels = {{"speed", "rpm", {}}, {channel, "um", o.drift_um}, {channel + " corrected", "um", o.left_um}}};
  for (double t_s : o.time_s) test.channels.front().values.push_back(run.cyclogram.speed_rpm(t_s));
  for (const char* feed : {"feed_x", "feed_y", "feed_z"}) {
    if (const Channel* recorded = run.readings.find(feed); recorded && recorded->values.size() == o.time_s.size())
      test.channels.push_back(*recorded);
  }
  return iso230_3_figures(test);
}

/// The run as measured, and its notes.
MachineRun read_run(const Scenario& scenario, const DeployedPredictor& d, const CorrectionRequest& request,
                    std::vector<std::string>& notes) {
  RecordPaths paths;
  if (!request.after.empty()) paths.test.push_back(request.after);
  paths.test.push_back(request.measured);
  StudyRecords records = read_records(scenario, paths, &d.ambient);
  notes = records.notes;
  notes.insert(notes.end(), records.findings.begin(), records.findings.end());
  MachineRun run = std::move(records.test.back());
  if (!request.after.empty() && run.n_before == 0)
    throw InputError(
        fmt::format("{} does not continue {}: its times must begin within five rows of the other's end, with the same "
                    "channels in the same units",
                    request.measured, request.after));
  require_model_follows(scenario, d, run, records.ambient);
  return run;
}

/// The run as simulated; as in validate_strategies(), a predictor gets the recorded data, and not the changes by the
/// scenario's effects.
MachineRun simulate_observed(const Scenario& scenario, const scenarios::Model& model, const Cyclogram& cyclogram,
                             const Listener& listener) {
  if (const scenarios::Machine* full = model.full())
    scenarios::require_ways_out(full->placed.mesh, full->placed.balance, scenario.machine->where);
  return {cyclogram, scenario.machine->ambient,
          std::move(scenarios::simulate_cyclograms(scenario, model, {&cyclogram}, listener).front().record)};
}

/// Sets the thermometers' readings as this run has them in `validate`, if it judges the cyclogram in the scenario's
/// ambient. @returns  a note that says which
std::string read_as_judged(const Scenario& scenario, const Cyclogram& cyclogram, MachineRun& run) {
  std::optional<Record> read;
  if (scenario.validation) read = as_judged(*scenario.validation, cyclogram.name, run.readings);
  if (!read)
    return fmt::format("thermometers read exactly, for `validation` does not judge '{}' in the scenario's ambient",
                       cyclogram.name);
  run.readings = std::move(*read);
  return "thermometers read with noise and steps, as in this run of `validate`";
}

/// The drift that is known before the run. A driven predictor uses drive and ambient; for the inputs of others the modes
/// predict the temperatures.
std::vector<double> foretold_um(const Scenario& scenario, const scenarios::Model& model, const DeployedPredictor& d,
                                const MachineRun& run) {
  MachineRun known{run.cyclogram, run.ambient, {.source = {}, .time_s = run.readings.time_s, .channels = {}}};
  if (!d.predictor->is_driven() && !d.predictor->inputs().empty())
    known.readings = foretold_record(*scenario.machine, model.outputs(), modes_for(scenario, model, run.cyclogram),
                                     run.cyclogram, run.readings.time_s);
  return ahead(*d.predictor, known);
}

}  // namespace

CorrectionStudy correct_run(const Scenario& scenario, std::optional<DeployedPredictor> predictor,
                            const CorrectionRequest& request, const Listener& listener) {
  MachineRun run;
  std::vector<double> ahead_um;
  std::vector<std::string> notes;
  if (!request.cyclogram) {
    run = read_run(scenario, *predictor, request, notes);
  } else {
    const Cyclogram& cyclogram = *request.cyclogram;
    const scenarios::Model model = scenarios::open_model(scenario, {&cyclogram}, listener, false);
    run = simulate_observed(scenario, model, cyclogram, listener);
    if (request.through == "none" && predictor) notes.push_back(read_as_judged(scenario, cyclogram, run));
    if (!predictor) {
      predictor = by_thermal_modes(*scenario.machine, model.outputs(), modes_for(scenario, model, cyclogram),
                                   scenario.study->target);
      predictor->name = fmt::format("{} thermal modes in the mean drive", scenario.study->thermal_modes);
    }
    if (request.through == "schedule") ahead_um = foretold_um(scenario, model, *predictor, run);
  }
  const DeployedPredictor& d = *predictor;
  listener.begin("correcting");
  changeable_channel(run.readings, d.target) = scored_readings(run, d.target, d.from_start).at(d.target);
  CorrectionStudy o = request.through == "none"       ? through_none(d, run, request.probed_every_s)
                      : request.through == "injector" ? through_injector(scenario, d, run)
                                                      : through_schedule(scenario, d, run, ahead_um);
  drop_lead_in(o, run.n_before);
  o.iso = iso_figures(o, run, d.target);
  o.run = request.cyclogram ? request.cyclogram->name : run.readings.source;
  o.notes = std::move(notes);
  o.predictor = *std::move(predictor);
  return o;
}

}  // namespace driftwright::studies
