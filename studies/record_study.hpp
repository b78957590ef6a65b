#pragma once
// Records that sensors are ranked on and strategies judged by.

#include <span>

#include "base/record.hpp"
#include "compensation/predictors/observed_run.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::studies {

/// Records as the command line names them: files, or parts of them such as run.csv:0h..20h.
struct RecordPaths {
  std::vector<std::string> train = {};
  std::vector<std::string> test = {};
};

struct StudyRecords {
  std::vector<compensation::ObservedRun> train, test;
  std::string ambient;                ///< channel of the ambient in every record; "": not all have it in the same one
  std::vector<std::string> notes;     ///< how records were read and cut, a sentence each
  std::vector<std::string> findings;  ///< what is wrong with drive and ambient, a sentence each
};

/// Reads the records, or parts of them (scenarios/reader/record_part.hpp), and checks that they have the study's target. Drive and ambient are what the
/// scenario's effects say of the recorded ones. A part goes on from what came before it in its record. A single record to train on is cut
/// into runs at rests of its drive (scenarios/reader/record_runs.hpp).
/// @throws InputError  for a missing file or channel, and when rows are given twice: trained on and judged by, or trained on twice
/// @param ambient  null: the ambient is read from the channel that all records have it in; else from this one alone, "" for none
[[nodiscard]] StudyRecords read_records(const scenarios::Scenario& scenario, const RecordPaths& paths,
                                        const std::string* ambient = nullptr);

/// The rows of the runs alone, as records.
[[nodiscard]] std::vector<Record> own_records(std::span<const compensation::ObservedRun> runs);

/// The records that the runs were cut from, each once and with what came before: what is looked at for broken sensors.
[[nodiscard]] std::vector<Record> whole_records(std::span<const compensation::ObservedRun> runs, const std::string& target);

/// What a person would want to know of the candidates before anything is fitted to them: never changing, missing in part or moving as one. A line each.
[[nodiscard]] std::vector<std::string> sensor_warnings(const std::vector<Record>& records,
                                                       const std::vector<std::string>& candidates);

/// Channels that read the ambient: sensors on it.
[[nodiscard]] std::vector<std::string> ambient_sensors(const scenarios::Scenario& scenario);

}  // namespace driftwright::studies
