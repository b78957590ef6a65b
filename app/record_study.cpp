#include "app/record_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scenarios/as_recorded.hpp"

namespace driftwright::app {
namespace {

using namespace compensation;

std::vector<std::string> candidates(const scenarios::Study& settings, const Record& record) {
  if (!settings.candidates.empty()) return settings.candidates;
  std::vector<std::string> names;
  for (const Channel& c : record.channels) {
    const bool is_temperature = (c.unit == "degC" || c.unit == "K") && c.name != scenarios::kAmbient;
    if (is_temperature && &c != record.find(settings.target)) names.push_back(c.name);
  }
  if (names.empty()) throw InputError(fmt::format("{}: no temperature channel (degC or K) to choose from", record.source));
  return names;
}

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> d;
  for (std::size_t i = 0; i < a.size(); ++i) d.push_back(a[i] - b[i]);
  return d;
}

}  // namespace

RecordStudy read_records(const scenarios::Study& study, const RecordOptions& options) {
  RecordStudy records;
  records.target = study.target;
  for (const std::string& file : options.train) {
    for (const std::string& test : options.test) {
      std::error_code ignored;
      if (std::filesystem::equivalent(file, test, ignored)) {
        throw InputError(fmt::format("{}: a record cannot be both trained on and judged by", file));
      }
    }
    if (std::count(options.train.begin(), options.train.end(), file) > 1) {
      throw InputError(fmt::format("{}: --train names this record twice; it would count double", file));
    }
    records.train.push_back(read_record_csv(file));
    (void)records.train.back().at(study.target);
  }
  for (const std::string& file : options.test) {
    records.test.push_back(read_record_csv(file));
    (void)records.test.back().at(study.target);
  }
  return records;
}

void rank(RecordStudy& study, const scenarios::Study& settings) {
  study.ranking = rank_channels(study.train, study.target, candidates(settings, study.train.front()));
}

void fit_and_judge(RecordStudy& study, const scenarios::Study& settings) {
  rank(study, settings);
  study.regression = fit_regression(study.train, best(study.ranking, settings.sensors_to_choose), study.target);
  for (const Record& test : study.test) {
    const std::vector<double>& measured = test.at(study.target).values;
    const std::vector<std::pair<const char*, std::vector<double>>> predictions = {
        {"regression", study.regression.predict(test)},
        {"mean of the training records", baseline_mean(study.train, test, study.target)},
        {"training records at the same time", baseline_same_time(study.train, test, study.target)}};
    // Judged on the rows that all three can predict, or they could not be compared.
    std::vector<double> common = measured;
    for (const auto& [strategy, predicted] : predictions) {
      for (std::size_t i = 0; i < common.size(); ++i) {
        if (std::isnan(predicted[i])) common[i] = predicted[i];
      }
    }
    for (const auto& [strategy, predicted] : predictions) {
      study.judged.push_back({strategy, test.source, predicted, score(difference(common, predicted))});
    }
  }
}

}  // namespace driftwright::app
