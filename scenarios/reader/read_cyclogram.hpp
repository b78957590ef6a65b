#pragma once
// Reads what drives the machine: rows, a record CSV or an NC program (docs/how-to/cyclograms.md).

#include "base/config_map.hpp"
#include "base/cyclogram.hpp"
#include "nc/program.hpp"

namespace driftwright::scenarios {

/// The schema of the map `cyclograms`.
[[nodiscard]] schema::Map cyclograms_schema();
/// The keys for an NC program: those of read_nc_settings(), resolution and cutting_power.
[[nodiscard]] std::vector<schema::Key> nc_keys();

/// Reads the cyclogram `name` of the map `cyclograms`. Paths in it are relative to the folder of the scenario.
/// @throws InputError  file, line and column of the scenario, the CSV or the NC program
[[nodiscard]] Cyclogram read_cyclogram(const ConfigMap& cyclograms, const std::string& name);

/// The map {columns, rows} that read_cyclogram() reads as this cyclogram: one row for each stretch in which the drive and
/// all columns are constant. Numbers have 9 digits.
[[nodiscard]] std::string rows_yaml(const Cyclogram& cyclogram);

/// Reads the keys dialect, rapid, tool_change, dwell_unit, machine_zero and ignore of an NC program. @throws InputError
[[nodiscard]] NcSettings read_nc_settings(const ConfigMap& in);

/// The cyclogram of an NC program (nc_sections.hpp), with its remarks and the places of its axes as columns
/// (nc/positions.hpp).
/// @param origin_m  from which these count, in the coordinates of the program: the machine's zero where it is known
/// @throws InputError  for a program without duration, or with a spindle speed beyond any machine
[[nodiscard]] Cyclogram cyclogram_of(const NcProgram& program, const std::string& name, double resolution_s,
                                     double cutting_power_W, const std::array<double, 3>& origin_m = {0.0, 0.0, 0.0});

}  // namespace driftwright::scenarios
