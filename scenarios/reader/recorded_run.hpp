#pragma once
// The one door for records: what drove the machine, what surrounded it and what was read, whoever made the record.

#include <string>
#include <vector>

#include "base/cyclogram.hpp"
#include "base/record.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {

/// Something wrong with the data themselves.
struct DataFinding {
  std::string channel;
  std::string what;         ///< a sentence
  bool leaves_out = false;  ///< the channel is not used
};

/// How much a reader of records bears.
enum class Reading {
  kStrict,   ///< a record must say what drove the machine
  kLenient,  ///< what is missing or unfit is a finding, and the rest is used
  kPlan,     ///< a record that says what is to be driven: from time 0, every value there, each taken as it is
};

/// A record as a run of the machine. Its readings stay as they were recorded.
struct RecordedRun {
  std::vector<double> time_s;  ///< of the rows, from 0
  /// The drive: each row's from its time on; no section where no speed was recorded. Named as the file. Its columns: whatever else was recorded that
  /// is no output of the machine and has a unit that may drive one (is_of_column()), what is missing held.
  Cyclogram cyclogram;
  TimeSeries
      ambient;  ///< as read, its last reading held; else the machine's; minus the reference [K]; no knot where neither is known
  std::string
      ambient_channel;  ///< that was read for it: `ambient`, else a sensor on the ambient; "" where none has a reading
  std::vector<DataFinding> findings;
  [[nodiscard]] bool has_ambient() const { return !ambient_channel.empty(); }
};

/// Whether a unit of a record may be that of something that drives a machine: all but lengths, angles and times.
[[nodiscard]] bool is_of_column(const std::string& unit);

/// @param record   two rows at least; its source names it in messages
/// @param machine  of the scenario; null: there is none, and the reference is 20 degC
/// @param on_ambient  channels that read the ambient as well as `ambient` does
/// @throws InputError  strict: without a speed, with speeds and powers below 0 (the sign of a feed does not count), values that no machine has or
///                     units that fit no drive or ambient, with an ambient in another unit than its header says. Plan: for missing values and a
///                     late start, too. Lenient: never
[[nodiscard]] RecordedRun run_of(const Record& record, const MachineModel* machine,
                                 const std::vector<std::string>& on_ambient, Reading reading);

}  // namespace driftwright::scenarios
