#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <string_view>

#include "app/results.hpp"
#include "app/schedule_files.hpp"
#include "base/delimited_text.hpp"
#include "base/file_bytes.hpp"
#include "base/file_name.hpp"
#include "findings/plausibility.hpp"
#include "findings/schedule_document.hpp"
#include "scenarios/reader/read_cyclogram.hpp"
#include "scenarios/reader/unusual.hpp"
#include "studies/known_speed.hpp"
#include "studies/planner.hpp"

namespace driftwright::app {
namespace {

using studies::CorrectedProgram, studies::CorrectedSeries;

const scenarios::ScheduleSettings& require_schedule(const scenarios::Scenario& scenario) {
  if (scenario.schedule) return *scenario.schedule;
  throw InputError(
      fmt::format("{}: `schedule` needs the key `schedule`, which says at least how fast rapids are, such as\n  schedule: "
                  "{{tolerance: 10 um, rapid: "
                  "15 m/min}}",
                  scenario.path));
}

/// Times of one part from its start. Durations that are summed in another order end slightly elsewhere by rounding; the
/// last sample is set to the end.
std::vector<double> part_times_s(const studies::Prediction& prediction, const scenarios::PartRows& rows, double end_s) {
  const std::vector<double>& all_s = prediction.record.time_s;
  std::vector<double> time_s;
  for (std::size_t i = rows.first; i <= rows.last; ++i) time_s.push_back(all_s[i] - all_s[rows.first]);
  if (!(std::abs(time_s.back() - end_s) <= 1e-6 * end_s))
    throw std::logic_error("a prediction of another length than its program");
  time_s.back() = end_s;
  return time_s;
}

/// The drift of one part along the axes to correct, relative to where the machine was set.
std::vector<compensation::ProgramAxis> axes_of(const CorrectedSeries& series, const scenarios::PartRows& rows) {
  std::vector<compensation::ProgramAxis> axes;
  for (const scenarios::ScheduleAxis& axis : series.settings.axes) {
    const std::vector<double>& all_um = series.prediction.record.at(axis.displacement).values;
    std::vector<double> drift_um(all_um.begin() + static_cast<std::ptrdiff_t>(rows.first),
                                 all_um.begin() + static_cast<std::ptrdiff_t>(rows.last) + 1);
    const double zero_um = series.settings.from_start ? drift_um.front() : 0.0;
    for (double& d : drift_um) d -= zero_um;
    axes.push_back({axis.axis, axis.sign, axis.tolerance_um, std::move(drift_um)});
  }
  return axes;
}

std::string between(const ScheduleVerbOptions& options, const scenarios::ScheduleSettings& settings) {
  if (!options.between.empty()) return options.between;
  return settings.between_s > 0.0 ? fmt::format("{} s", settings.between_s) : "";
}

/// The limits of the scenario, with its own defaults for speed and feed.
MachineLimits limits_for(const scenarios::Scenario& scenario, const scenarios::ScheduleSettings& settings) {
  MachineLimits limits = scenario.limits;
  const double top_rpm = studies::known_speed_rpm(scenario);
  if (std::isinf(limits.speed_rpm) && top_rpm > 0.0) limits.speed_rpm = top_rpm;  // 0: no law or cyclogram has a speed
  if (std::isinf(limits.feed_m_s) && settings.nc.rapid_m_s) limits.feed_m_s = *settings.nc.rapid_m_s;
  return limits;
}

/// @throws InputError  with the line, for the first block beyond a limit
void refuse_beyond(const CorrectedSeries& series, const scenarios::Scenario& scenario) {
  if (series.beyond.empty()) return;
  using What = compensation::BlockBeyond::What;
  const compensation::BlockBeyond& block = series.beyond.front();
  const std::string_view word = block.what == What::kSpeed ? "S word" : block.what == What::kFeed ? "F word" : "position";
  std::string whose;  // where the limit is written
  if (block.what == What::kTravel) {
    whose = "`travel` of `limits`";
  } else if (block.what == What::kFeed) {
    whose = std::isfinite(scenario.limits.feed_m_s) ? "`feed` of `limits`" : "as fast as `rapid` of `schedule`";
  } else if (std::isfinite(scenario.limits.speed_rpm)) {
    whose = "`speed` of `limits`";
  }
  const std::string what =
      !whose.empty()
          ? fmt::format("{} ({} in {}). Correct the {}, or add --beyond, which holds the correction there",
                        compensation::words_of(block), whose, scenario.path, word)
          : fmt::format(
                "the spindle turns at {:g} rpm here, and {} says nothing of a speed above {:g} rpm: a drift planned "
                "there would be made up. Give a cyclogram that reaches it, correct the S word, or add --beyond, "
                "which holds the correction there",
                block.value, scenario.path, block.limit);
  throw InputError(series.program.steps[block.step].where, what);
}

/// @throws InputError  with the line, for the first correction that a limit does not allow
void refuse_held(const CorrectedSeries& series, const scenarios::Scenario& scenario) {
  for (const CorrectedProgram& program : series.programs) {
    const compensation::ProgramSchedule& plan = program.shared.plan;
    if (plan.held.empty()) continue;
    const compensation::HeldCorrection& held = plan.held.front();
    const std::string axis(1, "XYZ"[series.settings.axes[held.axis].axis]);
    const CorrectionLimits& limits = series.limits.correction;
    const std::string what =
        held.is_step
            ? fmt::format(
                  "the correction of {} would change from {:g} to {:g} um here, but `step` of `limits` in {} allows "
                  "{:g} um at once. Allow a larger step, or add --beyond, which holds the correction",
                  axis, held.held_um, held.planned_um, scenario.path, limits.most_step_um)
            : fmt::format(
                  "the correction of {} would be {:g} um here, but `correction` of `limits` in {} allows {:g} um at "
                  "most. Allow a larger correction, or add --beyond, which holds the correction",
                  axis, held.planned_um, scenario.path, limits.most_um);
    throw InputError(series.program.steps[held.first].where, what);
  }
}

/// Comments for the corrected program: the limits that its corrections keep.
std::vector<std::string> limit_remarks(const CorrectedSeries& series) {
  const CorrectionLimits& limits = series.limits.correction;
  std::vector<std::string> remarks;
  if (std::isfinite(limits.most_um))
    remarks.push_back(fmt::format("no correction is larger than {:g} um, the limit of the scenario", limits.most_um));
  if (std::isfinite(limits.most_step_um))
    remarks.push_back(
        fmt::format("no correction changes by more than {:g} um at once, the limit of the scenario", limits.most_step_um));
  if (!series.beyond.empty())
    remarks.emplace_back("BEYOND THE LIMITS. In blocks beyond the limits of the machine the correction is held");
  return remarks;
}

/// Plans all parts and writes the programs.
void correct(CorrectedSeries& series, const std::string& bytes) {
  const scenarios::ScheduleSettings& settings = series.settings;
  NcOffsetOptions offsets{.language = series.program.language,
                          .absolute = settings.absolute,
                          .work_offset = settings.work_offset,
                          .base_m = settings.base_offset_m,
                          .axes = {false, false, false},
                          .remarks = limit_remarks(series)};
  for (const scenarios::ScheduleAxis& axis : settings.axes) offsets.axes[axis.axis] = true;
  const std::vector<scenarios::PartRows>& rows = series.prediction.parts;
  const std::vector<double> time_s = part_times_s(series.prediction, rows.front(), series.program.duration_s());
  std::vector<std::vector<compensation::ProgramAxis>> parts;
  for (const scenarios::PartRows& part : rows) {
    if (part.last - part.first != rows.front().last - rows.front().first)
      throw std::logic_error("parts of one program with other rows");
    parts.push_back(axes_of(series, part));
  }
  compensation::ProgramScheduleOptions how{
      .policy = studies::policy_of(settings.policy), .split = series.split, .limits = series.limits.correction};
  if (!series.beyond.empty()) how.held_steps.assign(series.program.steps.size(), 0);
  for (const compensation::BlockBeyond& block : series.beyond) how.held_steps[block.step] = 1;
  for (compensation::SharedPlan& shared : compensation::plan_series(series.program.steps, time_s, parts, how)) {
    CorrectedProgram program{
        .file = studies::corrected_file(series.file, shared, rows.size()), .shared = {}, .corrected = {}};
    program.corrected =
        corrected_nc_program(bytes, series.program.steps, compensation::initial_shift_m(shared.plan, shared.axes),
                             compensation::offset_changes(shared.plan, shared.axes), offsets);
    program.shared = std::move(shared);
    series.programs.push_back(std::move(program));
  }
}

}  // namespace

void schedule(const ScheduleVerbOptions& options) {
  scenarios::Scenario scenario = read_scenario(options, Told::kInDocument);
  (void)scenarios::require_machine(scenario, "schedule");
  const std::filesystem::path given = options.program;
  CorrectedSeries series{.file = file_name(given.stem().string(), given.extension().string()),
                         .settings = require_schedule(scenario),
                         .split = options.split};
  if (const std::set<std::string> ours = {"schedule.txt", "schedule.csv", "record.csv", "record_band.csv", "report.html",
                                          "summary.json", "figures", "tables", output::kManifestName};
      ours.contains(series.file))
    throw InputError(
        fmt::format("{}: `schedule` writes a file or folder of this name of its own; rename the program", options.program));
  if (!options.policy.empty()) series.settings.policy = options.policy;
  if (!options.dialect.empty()) series.settings.nc.control = options.dialect;
  const scenarios::ScheduleSettings& settings = series.settings;
  const int parts = options.parts > 0 ? options.parts : settings.parts;
  if (!options.between.empty() && parts == 1)
    throw InputError("--between is the time between two parts, and there is one: give --parts, or `parts` in the schedule");
  series.program = read_nc_program(options.program, settings.nc);
  series.limits = limits_for(scenario, settings);
  series.beyond = compensation::blocks_beyond(series.program.steps, series.limits);
  if (!options.beyond) refuse_beyond(series, scenario);
  if (options.beyond) scenario.limits.speed_rpm = std::numeric_limits<double>::infinity();  // predicted by extrapolation
  const std::string bytes = read_bytes(options.program);
  series.cyclogram = scenarios::cyclogram_of(series.program, std::filesystem::path(series.file).stem().string(),
                                             settings.resolution_s, settings.cutting_power_W);
  if (series.cyclogram.sections.empty())
    throw InputError(fmt::format("{}: the program takes no time; there is no drift to correct", options.program));
  scenarios::check_cyclogram(scenario, series.cyclogram);
  const studies::PredictionOptions asked{.start = options.start,
                                         .after_pause = options.after_pause,
                                         .parts = parts,
                                         .between = between(options, settings),
                                         .model = options.model,
                                         .with_band = true};
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  series.prediction = studies::predict_drift(scenario, series.cyclogram, asked, progress.listener(), "schedule");
  const studies::Prediction& prediction = series.prediction;
  if (series.is_series())
    series.between_s =
        prediction.record.time_s[prediction.parts[1].first] - prediction.record.time_s[prediction.parts[0].last];
  series.iso = studies::iso_figures(prediction);
  progress.begin("planning corrections");
  correct(series, bytes);
  if (!options.beyond) refuse_held(series, scenario);
  const std::string what =
      fmt::format("predicted by the {} for {}{}{}", prediction.predicted_by, clean_name(options.program),
                  series.is_series() ? fmt::format(", {} parts", prediction.parts.size()) : "",
                  prediction.started_from.empty() ? "" : ", after " + prediction.started_from);
  for (const CorrectedProgram& program : series.programs) folder.write_text(program.file, program.corrected.text);
  folder.write_text("record.csv", record_csv(prediction.record, provenance_lines(folder.made_by(), what)));
  if (prediction.band && !prediction.band->limits.channels.empty())
    folder.write_text("record_band.csv", band_csv(*prediction.band, folder.made_by()));
  const std::string notation = schedule_notation(series);
  folder.write_text("schedule.txt", notation);
  folder.write_text("schedule.csv",
                    schedule_csv(series, provenance_lines(folder.made_by(), "corrections of the drift " + what)));
  output::Document document = findings::document_of(series, scenario.name, notation, folder.made_by());
  findings::add_plausibility(document.body, scenario, scenarios::unusual_values(prediction.record));
  finish(document, folder, progress, options);
}

}  // namespace driftwright::app
