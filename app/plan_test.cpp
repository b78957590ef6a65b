#include <fmt/format.h>

#include <algorithm>

#include "app/kept_pieces.hpp"
#include "app/results.hpp"
#include "base/option_quantity.hpp"
#include "findings/test_plan_document.hpp"
#include "scenarios/reader/read_cyclogram.hpp"
#include "studies/test_plan.hpp"
#include "studies/warm_up_program.hpp"

namespace driftwright::app {
namespace {

bool is_of_spindle_alone(const Cyclogram& c) {
  return std::all_of(c.sections.begin(), c.sections.end(),
                     [](const auto& s) { return s.drive == Drive{.speed_rpm = s.drive.speed_rpm}; });
}

}  // namespace

void plan_test(const PlanTestOptions& options) {
  const scenarios::Scenario scenario = read_scenario(options);
  (void)scenarios::require_machine(scenario, "plan-test");
  studies::TestPlanOptions how{
      .interval_s = scenario.solver.output_interval_s, .n_programmes = options.n_programmes, .seed = options.seed};
  if (!options.time.empty()) how.duration_s = 3600.0 * option_quantity("--time", options.time, "h", 0.5, 168.0);
  constexpr double kMostRows = 20000.0;  // by a column for each law in doubt: 16 MB for 100 laws
  const double finest_s = std::max(0.1, how.duration_s / kMostRows);
  how.interval_s = std::clamp(how.interval_s, finest_s, how.duration_s / 96.0);
  if (!options.interval.empty())
    how.interval_s = option_quantity("--interval", options.interval, "s", finest_s, how.duration_s / 96.0);
  if (!options.speed_limit.empty())
    how.most_speed_rpm = option_quantity("--speed-limit", options.speed_limit, "rpm", 10.0, 1e6);
  scenarios::require_speed_within_limits(scenario, how.most_speed_rpm, "--speed-limit");
  if (!options.noise_K.empty())
    how.noise.temperature_K = option_quantity("--noise-temperature", options.noise_K, "K", 1e-4, 10.0);
  if (!options.noise_um.empty())
    how.noise.displacement_um = option_quantity("--noise-displacement", options.noise_um, "um", 1e-3, 1e3);
  KeptPieces kept(checked_results(options, scenario.name), options, options.scenario,
                  {"plan-test", options.time, options.speed_limit, options.interval, options.noise_K, options.noise_um,
                   fmt::format("{} {}", options.n_programmes, options.seed)});
  Progress progress(options.quiet);
  const std::optional<studies::TestPlan> planned = studies::plan_test(scenario, how, progress.listener(), kept.pieces());
  progress.end();
  if (!planned) {
    const std::string said = kept.finish_shard("the same command with");
    if (!options.quiet && !options.json) fmt::print("{}: {}", scenario.name, said);
    return;
  }
  const studies::TestPlan& plan = *planned;
  output::ResultsFolder folder = open_results(options, scenario.name);
  const std::string what = fmt::format("test programme of {}", scenario.name);
  const std::string rows = fmt::format("cyclograms:\n  planned: {}\n", scenarios::rows_yaml(plan.planned.cyclogram));
  folder.write_text("plan_test.yaml", fmt::format("# {}\n{}", what, rows));
  if (is_of_spindle_alone(plan.planned.cyclogram))
    folder.write_text("plan_test.ngc", studies::warm_up_program(plan.planned.cyclogram.sections, what));
  folder.write_text(
      "record.csv",
      record_csv(plan.planned_record,
                 provenance_lines(folder.made_by(),
                                  fmt::format("what {} would read as it is written, in its {}", scenario.name, what))));
  finish(findings::document_of(plan, scenario, rows, folder.made_by()), folder, progress, options);
  kept.remove();
}

}  // namespace driftwright::app
