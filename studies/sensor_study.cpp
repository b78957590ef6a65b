#include "studies/sensor_study.hpp"

#include "base/errors.hpp"
#include "compensation/predictors/scored_rows.hpp"
#include "studies/validation_study.hpp"

namespace driftwright::studies {

using namespace compensation;

SensorStudy study_sensors(const scenarios::Scenario& scenario, const RecordPaths& paths) {
  const scenarios::Study& settings = scenarios::require_study(scenario, "select");
  const StudyRecords read = read_records(scenario, paths);
  const std::vector<Record> training = own_records(read.train);
  const std::vector<std::string> all = candidate_sensors(settings, training.front()),
                                 candidates = usable_sensors(training, all);
  std::vector<Record> records;
  for (const MachineRun& run : read.train)
    records.push_back(own_rows(scored_readings(run, settings.target, settings.count_from_start), run.n_before));
  const GreyOptions how{
      .image = settings.image,
      .quantity = settings.count_from_start ? compensation::Quantity::kRise : compensation::Quantity::kAsRecorded};
  const std::string& target = settings.target;
  const int n = settings.sensors_to_choose;

  SensorStudy study{.target = target,
                    .n_to_choose = n,
                    .ranking = rank_channels(records, target, candidates, how),
                    .stability = ranking_stability(records, target, candidates, how, n),
                    .others = {},
                    .chosen = {},
                    .warnings = read.notes};
  const std::vector<std::string> of_sensors = sensor_warnings(whole_records(read.train, target), all);
  study.warnings.insert(study.warnings.end(), of_sensors.begin(), of_sensors.end());
  for (const compensation::Quantity quantity : {compensation::Quantity::kAsRecorded, compensation::Quantity::kRise}) {
    for (const Image image : {Image::kInitialValue, Image::kMeanValue, Image::kRange}) {
      OtherRanking other{.image = image, .quantity = quantity, .best = {}, .not_defined = {}};
      try {
        other.best = best(rank_channels(records, target, candidates, {.image = image, .quantity = quantity}), n);
      } catch (const InputError& e) {
        other.not_defined = e.what();
      }
      study.others.push_back(std::move(other));
    }
  }
  for (const Selector& selector : selectors(how)) {
    ChosenSensors c{.selector = selector.name, .selection = {}, .regression = {}, .quality = {}, .not_possible = {}};
    try {
      c.selection = selector.select(records, candidates, target, n);
    } catch (const InputError& e) {
      c.not_possible = e.what();
    }
    if (c.not_possible.empty()) {
      c.regression = fit_regression(records, c.selection.sensors, target);
      c.quality = regression_quality(records, c.regression);
    }
    study.chosen.push_back(std::move(c));
  }
  return study;
}

}  // namespace driftwright::studies
