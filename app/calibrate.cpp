#include <fmt/format.h>

#include "app/diagnosis_files.hpp"
#include "app/results.hpp"
#include "base/delimited_text.hpp"
#include "diagnosis/calibration.hpp"
#include "findings/diagnosis_document.hpp"

namespace driftwright::app {

void calibrate(const CalibrateOptions& options) {
  const scenarios::Scenario scenario = read_scenario(options);
  (void)scenarios::require_machine(scenario, "calibrate");
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  studies::MeasuredTwin m = studies::open_measured_twin(scenario, "calibrate", options.measured, progress.listener());
  diagnosis::Diagnosis d =
      diagnosis::calibrate(*m.twin, m.on_other_mesh ? &*m.on_other_mesh : nullptr, m.runs, m.how, progress.listener());
  progress.begin("writing");
  const std::string warning = findings::calibration_warning(d);
  std::vector<std::string> head = {
      fmt::format("{} with its numbers as `driftwright calibrate` fitted them", clean_name(options.scenario))};
  for (const std::string& path : options.measured) head.push_back("  measured: " + clean_name(path));
  if (!warning.empty()) head.push_back("WARNING: " + warning);
  head.emplace_back("");
  std::string difference;
  const diagnosis::ExtendedScenario calibrated = write_scenario(
      "calibrated", m, d.written.keeps_numbers ? stated_scatter(d, false) : std::vector<diagnosis::StatedChange>{}, head,
      folder, &difference);
  if (calibrated.not_written.empty()) simulate_written(m, calibrated, d);
  finish(findings::calibration_document({m, d, calibrated, difference, "calibrated.yaml"}, folder.made_by()), folder,
         progress, options, "", "calibration.json");
}

}  // namespace driftwright::app
