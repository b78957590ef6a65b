#include <fmt/format.h>

#include <filesystem>

#include "app/job_program.hpp"
#include "app/results.hpp"
#include "base/option_quantity.hpp"
#include "findings/plausibility.hpp"
#include "findings/warm_up_document.hpp"
#include "scenarios/reader/read_cyclogram.hpp"
#include "scenarios/reader/unusual.hpp"
#include "studies/warm_up_program.hpp"

namespace driftwright::app {
namespace {

/// A cyclogram of the scenario, a record CSV, or an NC program as the scenario's schedule reads it.
Cyclogram job_of(const scenarios::Scenario& scenario, const std::string& then) {
  if (!names_nc_program(scenario, then)) return studies::named_cyclogram(scenario, then);
  const NcProgram program = read_job_program(scenario, then);
  Cyclogram job = scenarios::cyclogram_of(program, std::filesystem::path(then).stem().string(),
                                          scenario.schedule->resolution_s, scenario.schedule->cutting_power_W);
  if (job.sections.empty()) throw InputError(fmt::format("{}: the program takes no time; it warms nothing", then));
  scenarios::check_cyclogram(scenario, job);
  return job;
}

}  // namespace

void warmup(const WarmUpVerbOptions& options) {
  const scenarios::Scenario scenario = read_scenario(options, Told::kInDocument);
  (void)scenarios::require_machine(scenario, "warmup");
  studies::WarmUpOptions how{.from = {.start = options.start, .after_pause = options.after_pause, .model = options.model},
                             .channels = options.channels,
                             .tolerance_um = scenario.study ? scenario.study->tolerance_um : 10.0};
  if (!options.tolerance.empty()) how.tolerance_um = option_quantity("--tolerance", options.tolerance, "um", 1e-3, 1e4);
  if (!options.margin.empty()) how.kept_free = option_quantity("--margin", options.margin, "1", 0.0, 0.95);
  if (!options.model_error.empty()) how.model_error = option_quantity("--model-error", options.model_error, "1", 0.001, 1.0);
  if (!options.power_limit.empty()) how.most_power_W = option_quantity("--power-limit", options.power_limit, "W", 0.1, 1e6);
  if (!options.speed_limit.empty())
    how.most_speed_rpm = option_quantity("--speed-limit", options.speed_limit, "rpm", 10.0, 1e6);
  scenarios::require_speed_within_limits(scenario, how.most_speed_rpm, "--speed-limit");
  if (!options.time_limit.empty())
    how.most_s = option_quantity("--time-limit", options.time_limit, "s", 60.0, 7.0 * 86400.0);
  const Cyclogram job = job_of(scenario, options.then);
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  const studies::WarmUpPlan plan = studies::plan_warm_up(scenario, job, how, progress.listener());
  const std::string what = fmt::format("warm-up of {} before {}", scenario.name, job.name);
  if (plan.best().is_enough && !plan.best().sections.empty()) {
    folder.write_text("warmup.ngc", studies::warm_up_program(plan.best().sections, what));
    Record rows{.source = "warmup", .time_s = {0.0}, .channels = {{"speed", "rpm", {}}}};
    for (const Cyclogram::Section& section : plan.best().sections) {
      rows.channels.front().values.push_back(section.drive.speed_rpm);
      rows.time_s.push_back(rows.time_s.back() + section.duration_s);
    }
    rows.channels.front().values.push_back(0.0);  // at the end
    const std::string from = plan.started_from.empty() ? "from the scenario's start" : "after " + plan.started_from;
    folder.write_text("warmup.csv", record_csv(rows, provenance_lines(folder.made_by(), fmt::format("{}, {}", what, from))));
  }
  folder.write_text(
      "record.csv",
      record_csv(plan.job_warm, provenance_lines(folder.made_by(), fmt::format("{} after its {}", job.name, what))));
  output::Document document = findings::document_of(plan, scenario, job, options.then, folder.made_by());
  findings::add_plausibility(document.body, scenario, scenarios::unusual_values(plan.job_at_once));
  finish(document, folder, progress, options);
}

}  // namespace driftwright::app
