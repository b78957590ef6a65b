#pragma once
// Reads the records on which sensors are ranked and strategies judged.

#include <span>

#include "base/machine_run.hpp"
#include "base/record.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::studies {

/// Records as on the command line: files, or parts of them such as run.csv:0h..20h.
struct RecordPaths {
  std::vector<std::string> train = {};
  std::vector<std::string> test = {};
};

struct StudyRecords {
  std::vector<MachineRun> train, test;
  std::string ambient;             ///< channel of the ambient in every record; "": the records do not all have the same one
  std::vector<std::string> notes;  ///< how records were read and split, one sentence each
  std::vector<std::string> findings;  ///< faults in drive and ambient, one sentence each
};

/// Reads the records, or parts of them (scenarios/reader/record_part.hpp), and checks that they have the study's target.
/// Drive and ambient are the recorded ones as changed by the scenario's effects. A part continues the rows before it in
/// its record. A single training record is split into runs at rests of its drive (scenarios/reader/record_runs.hpp).
/// @throws InputError  for a missing file or channel, and for rows that are given twice: for training and judging, or
/// twice for training
/// @param ambient  null: the ambient is read from the channel that all records have; otherwise only from this one, "" for
/// none
[[nodiscard]] StudyRecords read_records(const scenarios::Scenario& scenario, const RecordPaths& paths,
                                        const std::string* ambient = nullptr);

/// The rows of the runs only, as records.
[[nodiscard]] std::vector<Record> own_records(std::span<const MachineRun> runs);

/// The records that the runs were split from, each once and with the rows before: the search for broken sensors needs
/// them.
[[nodiscard]] std::vector<Record> whole_records(std::span<const MachineRun> runs, const std::string& target);

/// Warnings about the candidates before anything is fitted to them: constant, partly missing, or moving together. One
/// line each.
[[nodiscard]] std::vector<std::string> sensor_warnings(const std::vector<Record>& records,
                                                       const std::vector<std::string>& candidates);

/// Channels that read the ambient: sensors placed on it.
[[nodiscard]] std::vector<std::string> ambient_sensors(const scenarios::Scenario& scenario);

}  // namespace driftwright::studies
