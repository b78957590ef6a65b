#pragma once
// The only way to read records: drive, ambient and readings, whatever program made the record.

#include <string>
#include <vector>

#include "base/cyclogram.hpp"
#include "base/record.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {

/// A fault in the data themselves.
struct DataFinding {
  std::string channel;
  std::string what;         ///< a sentence
  bool leaves_out = false;  ///< the channel is not used
};

/// How strictly a record is read.
enum class Reading {
  kStrict,   ///< the record must contain the drive
  kLenient,  ///< missing or unsuitable data become findings, and the rest is used
  kPlan,     ///< a planned drive: from time 0, without gaps, each value used as it is
};

/// A record as a run of the machine. Its readings are unchanged.
struct RecordedRun {
  std::vector<double> time_s;  ///< of the rows, from 0
  /// The drive: each row's value holds from its time on; no section if no speed was recorded. Its name is the file's. Its
  /// columns: all other recorded channels that are no outputs of the machine and whose unit may drive one
  /// (is_of_column()), with gaps held.
  Cyclogram cyclogram;
  TimeSeries ambient;  ///< as recorded, its last reading held; else the machine's; minus the reference [K]; empty if unknown
  std::string
      ambient_channel;  ///< channel that it was read from: `ambient`, else a sensor on the ambient; "" if none has a reading
  std::vector<DataFinding> findings;
  [[nodiscard]] bool has_ambient() const { return !ambient_channel.empty(); }
};

/// Whether a channel of this unit may drive a machine: all units except those of lengths, angles and times.
[[nodiscard]] bool is_of_column(const std::string& unit);

/// @param record   at least two rows; its source names it in messages
/// @param machine  of the scenario; null: none, and the reference is 20 degC
/// @param on_ambient  channels that read the ambient just as `ambient` does
/// @throws InputError  strict: without a speed, for speeds and powers below 0 (the sign of a feed does not matter), for
/// impossible values or units that fit no drive or ambient, and for an ambient in another unit than its header says.
/// Plan: also for missing values and a late start. Lenient: never
[[nodiscard]] RecordedRun run_of(const Record& record, const MachineModel* machine,
                                 const std::vector<std::string>& on_ambient, Reading reading);

}  // namespace driftwright::scenarios
