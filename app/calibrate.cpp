#include "app/diagnosis_files.hpp"
#include "app/results.hpp"
#include "findings/diagnosis_document.hpp"
#include "studies/measured_diagnosis.hpp"

namespace driftwright::app {

void calibrate(const CalibrateOptions& options) {
  const scenarios::Scenario scenario = read_scenario(options);
  (void)scenarios::require_machine(scenario, "calibrate");
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  const studies::MeasuredTwin m =
      studies::open_measured_twin(scenario, "calibrate", options.measured, progress.listener(), options.as_recorded);
  const auto [d, written] = studies::calibrate(m, folder.target() / "calibrated.yaml", progress.listener());
  write_scenario("calibrated", written, folder);
  finish(findings::calibration_document({m, d, written.extended, written.difference, "calibrated.yaml"}, folder.made_by()),
         folder, progress, options, "", "calibration.json");
}

}  // namespace driftwright::app
