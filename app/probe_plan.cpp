#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "app/job_program.hpp"
#include "app/machine_predictor.hpp"
#include "app/results.hpp"
#include "base/mapped_record.hpp"
#include "base/option_quantity.hpp"
#include "findings/probe_plan_document.hpp"
#include "studies/prediction.hpp"
#include "studies/probe_job.hpp"

namespace driftwright::app {
namespace {

double fastest_rpm(const Cyclogram& cyclogram) {
  double most = 0.0;
  for (const Cyclogram::Section& s : cyclogram.sections) most = std::max(most, s.drive.speed_rpm);
  return most;
}

double fastest_rpm(const NcProgram& program) {
  double most = 0.0;
  for (const NcMove& m : program.moves) most = std::max(most, m.speed_rpm);
  return most;
}

/// A job, and its highest speed.
struct ReadJob {
  studies::ProbeJob job;
  double most_rpm = 0.0;
};

ReadJob read_job(const scenarios::Scenario& scenario, const std::string& text, const studies::ProbeJobOrder& order) {
  if (names_nc_program(scenario, text)) {
    const NcProgram program = read_job_program(scenario, text);
    return {studies::probe_job_of(program, std::filesystem::path(text).stem().string(), order), fastest_rpm(program)};
  }
  const Cyclogram cyclogram = studies::named_cyclogram(scenario, text);
  return {studies::probe_job_of(cyclogram, order), fastest_rpm(cyclogram)};
}

/// Rings that tell most about a table: all may be probed, with the noise of the scenario, and its judged points count.
studies::PointChoice table_points(const scenarios::Scenario& scenario, const std::vector<Record>& records,
                                  const ProbePlanOptions& options, std::size_t n_most) {
  studies::PointErrors errors = studies::table_point_errors(scenario, records);
  const auto first_judged = errors.names.begin() + static_cast<std::ptrdiff_t>(scenario.table->rings.size());
  std::vector<std::string> rings(errors.names.begin(), first_judged), judged(first_judged, errors.names.end());
  const double noise_um = options.noise.empty() ? 1e6 * scenario.table->probe_noise_m
                                                : option_quantity("--probe-noise", options.noise, "um", 1e-3, 1e3);
  return studies::choose_points(std::move(errors), options.may_probe.empty() ? rings : options.may_probe,
                                options.counting.empty() ? judged : options.counting, n_most, noise_um);
}

/// The gauge of --gauge and --touch; limits are not set.
compensation::AxisProgram axis_program(const ProbePlanOptions& options) {
  compensation::AxisProgram program{.axis = options.touch.front() - 'x', .toward = options.touch.back() == '+' ? 1.0 : -1.0};
  std::istringstream parts(options.gauge);
  int axis = 0;
  for (std::string part; std::getline(parts, part, ','); ++axis) {
    if (axis < 3) program.at_m[axis] = option_quantity("--gauge", part, "m", -100.0, 100.0);
  }
  if (axis != 3)
    throw InputError(fmt::format("--gauge '{}': three lengths with commas are required, such as '400 mm, 250 mm, -310 mm'",
                                 options.gauge));
  if (options.probe_tool < 1)
    throw InputError("--gauge: --probe-tool is required, the number of the probe in the tool table, such as 9");
  program.probe_tool = options.probe_tool;
  return program;
}

}  // namespace

void probe_plan(const ProbePlanOptions& options) {
  const scenarios::Scenario scenario = read_scenario(options);
  (void)scenarios::require_machine(scenario, "probe-plan");
  const output::PredictorFile file = read_machine_predictor(scenario, options.model);
  const compensation::DeployedPredictor& predictor = file.predictor;
  if (!predictor.residual)
    throw InputError(fmt::format(
        "{}: the file does not say what '{}' leaves (key `probing` is null or missing), so nothing says when a probing is "
        "due; `validate` writes it where parts of the training runs could be left out",
        options.model, predictor.name));
  double tolerance_um = scenario.study ? scenario.study->tolerance_um : 10.0;
  if (!options.tolerance.empty()) tolerance_um = option_quantity("--tolerance", options.tolerance, "um", 1e-3, 1e4);
  const double kept_free = options.margin.empty() ? 0.0 : option_quantity("--margin", options.margin, "1", 0.0, 0.95);
  compensation::Probe probe = predictor.probe;
  if (!options.noise.empty()) probe.noise_um = option_quantity("--probe-noise", options.noise, "um", 1e-3, 1e3);
  if (!options.lag.empty()) probe.lag_s = option_quantity("--probe-lag", options.lag, "s", 0.0, 3600.0);
  const double probing_s =
      options.probing_time.empty() ? 120.0 : option_quantity("--probing-time", options.probing_time, "s", 0.0, 3600.0);
  studies::ProbeJobOrder order{.n_parts = options.parts};
  if (!options.between.empty()) order.between_s = option_quantity("--between", options.between, "s", 0.0, 86400.0);
  ReadJob read = read_job(scenario, options.job, order);
  constexpr std::size_t kMostPlaces = 5000;
  if (read.job.places.size() > kMostPlaces)
    throw InputError(fmt::format("--job '{}' with --parts {}: there are {} places for a probing; at most {} are allowed",
                                 options.job, options.parts, read.job.places.size(), kMostPlaces));
  std::optional<compensation::AxisProgram> touch;
  if (!options.gauge.empty()) touch = axis_program(options);
  std::optional<studies::PointChoice> points;
  if (!options.points.empty()) {
    std::vector<Record> records;
    for (const std::string& path : options.points) records.push_back(read_record(path, scenario.columns).record);
    constexpr std::size_t kMostPoints = 8;
    points = scenario.table ? table_points(scenario, records, options, kMostPoints)
                            : studies::choose_points(studies::point_errors(records), options.may_probe, options.counting,
                                                     kMostPoints, probe.noise_um);
  }
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  studies::ProbePlan plan = studies::plan_probings(std::move(read.job), studies::probed_axis(predictor, probe, probing_s),
                                                   tolerance_um, kept_free);
  plan.predictor = predictor.name;
  plan.target = predictor.target;
  plan.points = std::move(points);
  if (touch) {
    const studies::TouchBounds bounds = studies::touch_bounds(plan);
    const CorrectionLimits& limits = scenario.limits.correction;
    touch->most_um = std::min(limits.most_um, 1e6 * compensation::kMostRise_m);
    touch->first_um = std::min(bounds.first_um, touch->most_um);
    touch->step_um = std::min({bounds.step_um, limits.most_step_um, touch->most_um});
    touch->to_component = predictor.predictor->formula() && predictor.fail_safe;  // `validate` wrote a component for it
    touch->made_by = fmt::format("Driftwright {}, scenario {}, {} corrected by {}", folder.made_by().version,
                                 folder.made_by().scenario, predictor.target, predictor.name);
    for (const compensation::ProgramFile& written : compensation::axis_programs(*touch))
      folder.write_text("control/" + written.name, written.text);
  }
  plan.touch = std::move(touch);
  std::vector<std::string> warnings;
  if (file.covered && read.most_rpm > file.covered->most_rpm)
    warnings.push_back(
        fmt::format("The job turns at up to {:.0f} rpm, and '{}' was fitted and judged at up to {:.0f} rpm: its "
                    "errors may be larger here",
                    read.most_rpm, predictor.name, file.covered->most_rpm));
  finish(findings::document_of(plan, scenario, warnings, folder.made_by()), folder, progress, options);
}

}  // namespace driftwright::app
