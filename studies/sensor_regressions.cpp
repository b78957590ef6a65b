#include "studies/sensor_regressions.hpp"

#include "compensation/sensors/thermometers.hpp"
#include "scenarios/reader/felt_run.hpp"

namespace driftwright::studies {

using namespace compensation;

SensorRegressions fit_on_best_sensors(std::vector<Record> training, const scenarios::Study& study,
                                      const std::vector<std::string>& displacements) {
  for (Record& record : training) record = as_read(std::move(record), {.resolution_K = study.sensor_resolution_K}, 0);
  const std::vector<std::string> candidates =
      study.candidates.empty() ? scenarios::sensor_channels(training.front()) : study.candidates;
  SensorRegressions result{.ranking = rank_channels(training, study.target, candidates, {.image = study.image})};
  const std::vector<std::string> inputs = best(result.ranking, study.sensors_to_choose);
  for (const std::string& d : displacements) {
    result.regressions.push_back(fit_regression(training, inputs, d));
    result.single_sensor.push_back(fit_regression(training, {inputs.front()}, d));
  }
  return result;
}

}  // namespace driftwright::studies
