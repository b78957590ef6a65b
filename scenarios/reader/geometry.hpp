#pragma once
// The geometry of a machine alone, as a scenario that is being written has it first: before supports, effects and cyclograms.

#include <string>

#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {

struct Geometry {
  std::string name;
  MachineModel machine;  ///< mesh, and materials, sensors and displacements as far as they are there; nothing else
};

/// Reads the keys `name`, `machine`, `materials`, `sensors` and `displacements` of a scenario and looks at no other: read_scenario() does.
/// @throws InputError
[[nodiscard]] Geometry read_geometry(const std::string& path);

}  // namespace driftwright::scenarios
