#pragma once
// Reads the unit of length of a STEP file.

#include <string>

namespace driftwright::mesh {

/// @returns  the unit [m]; 1e-3 for a file in mm
/// @throws InputError  if parts of the file have different units, or a unit other than SI units, inch and foot
[[nodiscard]] double unit_of_step_m(const std::string& path);

}  // namespace driftwright::mesh
