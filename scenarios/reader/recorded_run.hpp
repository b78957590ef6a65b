#pragma once
// The only way to read records: drive, ambient and readings, whatever program made the record.

#include <string>
#include <vector>

#include "base/machine_run.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {

/// Share of the top speed: a smaller change of the recorded speed is jitter, unless the new value stays.
inline constexpr double kJitter = 0.01;

/// How strictly a record is read.
enum class Reading {
  kStrict,   ///< the record must contain the drive
  kLenient,  ///< missing or unsuitable data become findings, and the rest is used
  kPlan,     ///< a planned drive: from time 0, without gaps, each value used as it is
};

/// Whether a channel may drive a machine: all units except those of lengths, angles and times; and the places of axes,
/// `position_...` in mm or deg and `stroke_...` in mm.
[[nodiscard]] bool is_of_column(const std::string& name, const std::string& unit);

/// A record as a run of the machine.
/// - readings: the record, unchanged, with its time from 0
/// - cyclogram: each row's value holds from its time on; no section if no speed was recorded. Its name is the file's. Its
///   columns: all other recorded channels that are no outputs of the machine and whose unit may drive one
///   (is_of_column()), with gaps held
/// - ambient: from the channel `ambient`, else a sensor on the ambient, as recorded, with gaps held; else the machine's, or
///   unknown without one. Minus the machine's reference temperature [K]
/// @param record   at least two rows; its source names it in messages
/// @param machine  of the scenario; null: none, and the reference is 20 degC
/// @param on_ambient  channels that read the ambient just as `ambient` does
/// @throws InputError  strict: without a speed, for speeds and powers below 0 (the sign of a feed does not matter), for
/// impossible values or units that fit no drive or ambient, and for an ambient in another unit than its header says.
/// Plan: also for missing values and a late start. Lenient: never
[[nodiscard]] MachineRun run_of(Record record, const MachineModel* machine, const std::vector<std::string>& on_ambient,
                                Reading reading);

}  // namespace driftwright::scenarios
