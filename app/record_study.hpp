#pragma once
// Records that sensors are ranked on and strategies judged by.

#include "app/verbs.hpp"
#include "base/record.hpp"
#include "scenarios/scenario.hpp"

namespace driftwright::app {

struct StudyRecords {
  std::vector<Record> train, test;
};

/// Reads the records and checks that they have the study's target.
/// @throws InputError  for a missing file or channel, and when a file is given twice: trained on and judged by, or trained on twice
[[nodiscard]] StudyRecords read_records(const scenarios::Study& study, const RecordOptions& options);

/// What a person would want to know of the candidates before anything is fitted to them: never changing, missing in part or moving as one. A line each.
[[nodiscard]] std::vector<std::string> sensor_warnings(const std::vector<Record>& records,
                                                       const std::vector<std::string>& candidates);

}  // namespace driftwright::app
