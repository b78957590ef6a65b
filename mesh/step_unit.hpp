#pragma once
// The unit of length that a STEP file says it is in.

#include <string>

namespace driftwright::mesh {

/// @returns  metres; 1e-3 of a file in mm
/// @throws InputError  where parts of the file are in several units, or in one that is no SI unit and no inch or foot
[[nodiscard]] double unit_of_step_m(const std::string& path);

}  // namespace driftwright::mesh
