#include "app/results.hpp"
#include "findings/sensor_document.hpp"

namespace driftwright::app {

void select(const RecordOptions& options) {
  const scenarios::Scenario scenario = read_scenario(options);
  const studies::SensorStudy study = studies::study_sensors(scenario, options);
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  finish(findings::document_of(study, scenario.name, options.train, folder.made_by()), folder, progress, options);
}

}  // namespace driftwright::app
