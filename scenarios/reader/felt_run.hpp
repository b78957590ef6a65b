#pragma once
// Drive and ambient that a machine really had, as opposed to its record, and checks of the instruments and columns that
// effects name.

#include "base/machine_run.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {

/// Channel of the recorded ambient temperature.
inline constexpr const char* kAmbient = "ambient";

/// The run that the machine really has while the record says `recorded` and the scenario's ambient: drive, ambient and what
/// drove the machine before, as its effects change them. It has no readings.
/// @throws InputError  if an effect requires a column that the cyclogram does not have, and if the cyclogram moves an axis
/// away from the model's pose (simulate_run() follows such cyclograms)
[[nodiscard]] MachineRun felt_run(const MachineModel& model, const Cyclogram& recorded);
/// The same for a cyclogram that is only examined: a missing column counts as 0.
[[nodiscard]] MachineRun felt_run_as_far_as_known(const MachineModel& model, const Cyclogram& recorded);
/// The columns that effects of the machine require of a cyclogram of that name, as the effects call them, without
/// channels of the drive.
[[nodiscard]] std::vector<std::string> wanted_columns(const MachineModel& model, const std::string& cyclogram);
/// @throws InputError  for a column that the cyclogram does not have, and for a displacement that would follow a column
/// that is no temperature
void require_columns(const MachineModel& model, const Cyclogram& cyclogram);
/// The ambient at the machine's start, minus the reference temperature [K], with the errors that all cyclograms share, so
/// that all cyclograms start at the same temperature.
[[nodiscard]] double felt_ambient_at_start_K(const MachineModel& model);
/// How much warmer a run begins than the machine usually starts [K], uniformly: nonzero if it starts at the ambient or in
/// balance with it, and the ambient record is wrong in this cyclogram only.
[[nodiscard]] double warmer_start_K(const MachineModel& model, const Cyclogram& recorded);
/// How much warmer the machine begins in another ambient than its own [K], uniformly: nonzero if it starts at the ambient or
/// in balance with it. @param ambient  minus the reference temperature [K]
[[nodiscard]] double warmer_start_K(const MachineModel& model, const TimeSeries& ambient);

/// Check for verbs that begin every cyclogram at the scenario's `start`.
/// @throws InputError  if an effect drives the machine before a cyclogram
void require_nothing_before(const MachineModel& model, const std::string& verb);

[[nodiscard]] bool is_on_ambient(const Sensor& sensor);
/// Whether the machine's records have the channel `ambient`.
[[nodiscard]] bool has_ambient_channel(const MachineModel& model);

/// Temperature channels of a record from which sensors are chosen: all except `ambient`.
[[nodiscard]] std::vector<std::string> sensor_channels(const Record& record);

/// Checks that the sensors, displacements, tilts and cyclograms that effects name exist.
/// @throws InputError  for one that does not exist, and for an amount that does not fit the channel
void check_instruments(const MachineModel& model, const std::vector<Cyclogram>& cyclograms);

}  // namespace driftwright::scenarios
