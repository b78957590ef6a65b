#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "app/schedule_report.hpp"
#include "app/verbs.hpp"
#include "base/file_bytes.hpp"
#include "scenarios/read_cyclogram.hpp"

namespace driftwright::app {
namespace {

const scenarios::ScheduleSettings& require_schedule(const scenarios::Scenario& scenario) {
  if (scenario.schedule) return *scenario.schedule;
  throw InputError(fmt::format(
      "{}: `schedule` needs the key `schedule`, which says at least what the work offset holds and how fast rapids "
      "are, such as\n  schedule: {{tolerance: 10 um, base_offset: [0 mm, 0 mm, 0 mm], rapid: 15 m/min}}",
      scenario.path));
}

NcDialect dialect_of(const std::string& name) {
  if (name == "siemens") return NcDialect::kSiemens;
  return name == "heidenhain" ? NcDialect::kHeidenhain : NcDialect::kLinuxCnc;
}

/// Times of the prediction. Durations added up in another order end elsewhere by rounding: the last sample is the end.
std::vector<double> program_times_s(const Record& record, double end_s) {
  std::vector<double> time_s = record.time_s;
  if (!(std::abs(time_s.back() - end_s) <= 1e-6 * end_s))
    throw std::logic_error("a prediction of another length than its program");
  time_s.back() = end_s;
  return time_s;
}

}  // namespace

void schedule(const ScheduleVerbOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  (void)require_machine(scenario, "schedule");
  CorrectedPart part{.file = std::filesystem::path(options.program).filename().string(),
                     .settings = require_schedule(scenario),
                     .split = options.split};
  if (const std::set<std::string> ours = {"schedule.txt", "schedule.csv", "record.csv", "report.html"};
      ours.contains(part.file))
    throw InputError(
        fmt::format("{}: `schedule` writes a file of this name of its own; rename the program", options.program));
  if (!options.policy.empty()) part.settings.policy = options.policy;
  if (!options.dialect.empty()) part.settings.dialect = options.dialect;
  const scenarios::ScheduleSettings& settings = part.settings;
  part.program = read_nc_program(options.program, settings.nc);
  const std::string bytes = read_bytes(options.program);
  part.cyclogram = scenarios::cyclogram_of(part.program, std::filesystem::path(part.file).stem().string(),
                                           settings.resolution_s, settings.cutting_power_W);
  if (part.cyclogram.sections.empty())
    throw InputError(fmt::format("{}: the program takes no time; there is no drift to correct", options.program));
  scenarios::check_cyclogram(scenario, part.cyclogram);
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress;
  part.prediction = predict_drift(scenario, part.cyclogram, progress, "schedule");
  progress.begin("planning corrections");
  const Record& record = part.prediction.record;
  NcOffsetOptions offsets{.dialect = dialect_of(settings.dialect),
                          .work_offset = settings.work_offset,
                          .base_m = settings.base_offset_m,
                          .axes = {false, false, false}};
  for (const scenarios::ScheduleAxis& axis : settings.axes) {
    std::vector<double> drift_um = record.at(axis.displacement).values;
    const double zero_um = settings.from_start ? drift_um.front() : 0.0;
    for (double& d : drift_um) d -= zero_um;
    part.axes.push_back({axis.axis, axis.sign, axis.tolerance_um, std::move(drift_um)});
    offsets.axes[axis.axis] = true;
  }
  part.plan = compensation::plan_program(
      part.program.steps, program_times_s(record, part.program.duration_s()), part.axes,
      {.policy = settings.policy == "paper" ? compensation::SchedulePolicy::kPaper : compensation::SchedulePolicy::kMinimal,
       .split = options.split});
  part.corrected = corrected_nc_program(bytes, part.program.steps, compensation::initial_shift_m(part.plan, part.axes),
                                        compensation::offset_changes(part.plan, part.axes), offsets);
  const std::string what = fmt::format("predicted by {} thermal modes for {}", part.prediction.n_modes, options.program);
  folder.write_text(part.file, part.corrected.text);
  folder.write_text("record.csv", record_csv(record, provenance_lines(folder.made_by(), what)));
  folder.write_text("schedule.txt", schedule_notation(part));
  folder.write_text("schedule.csv",
                    schedule_csv(part, provenance_lines(folder.made_by(), "corrections of the drift " + what)));
  folder.write_text("report.html", output::render_html(schedule_report(part, scenario.name, folder.made_by())));
  folder.commit();
  progress.end();
  fmt::print("{}  results in {}: {}, schedule.txt, schedule.csv, record.csv, report.html\n", schedule_terminal(part),
             shown_path(folder.target()), part.file);
}

}  // namespace driftwright::app
