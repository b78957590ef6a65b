#pragma once
// What a machine felt while its record says something else, and which instruments and columns its effects name.

#include "base/record.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {

/// Channel of the recorded ambient temperature.
inline constexpr const char* kAmbient = "ambient";

/// Drive and ambient as the machine feels them.
struct FeltRun {
  Cyclogram cyclogram;
  TimeSeries ambient;  ///< minus the reference temperature [K]
  Cyclogram before{};  ///< what drove it between its start and t = 0; most often no section
};
/// What is felt while the record says `recorded` and the scenario's ambient; its effects tell them apart.
/// @throws InputError  where an effect wants a column that the cyclogram does not have
[[nodiscard]] FeltRun felt_run(const MachineModel& model, const Cyclogram& recorded);
/// The same of a cyclogram that is looked at and not run: a column that it does not have counts as 0.
[[nodiscard]] FeltRun felt_run_as_far_as_known(const MachineModel& model, const Cyclogram& recorded);
/// Columns that effects of the machine want of a cyclogram of that name, as they call them; none of them a channel of the drive.
[[nodiscard]] std::vector<std::string> wanted_columns(const MachineModel& model, const std::string& cyclogram);
/// @throws InputError  for one that the cyclogram does not have, and for a displacement that would follow a column that is no temperature
void require_columns(const MachineModel& model, const Cyclogram& cyclogram);
/// The ambient that the machine starts in, minus the reference temperature [K]: with errors that every cyclogram has, so that all
/// of them start alike.
[[nodiscard]] double felt_ambient_at_start_K(const MachineModel& model);
/// How much warmer a run begins than the machine usually starts [K], everywhere: where it starts as warm as the ambient or in balance with it, and
/// the ambient record was wrong in this cyclogram alone.
[[nodiscard]] double warmer_start_K(const MachineModel& model, const Cyclogram& recorded);

/// For what begins every cyclogram at the scenario's `start`.
/// @throws InputError  where an effect has the machine driven before a cyclogram
void require_nothing_before(const MachineModel& model, const std::string& verb);

[[nodiscard]] bool is_on_ambient(const Sensor& sensor);
/// Whether the machine's records have the channel `ambient`.
[[nodiscard]] bool has_ambient_channel(const MachineModel& model);

/// Temperature channels of a record to choose sensors from: all but `ambient`.
[[nodiscard]] std::vector<std::string> sensor_channels(const Record& record);

/// Looks up the sensors, displacements, tilts and cyclograms that effects name.
/// @throws InputError  for one that does not exist, and for an amount that fits no such channel
void check_instruments(const MachineModel& model, const std::vector<Cyclogram>& cyclograms);

}  // namespace driftwright::scenarios
