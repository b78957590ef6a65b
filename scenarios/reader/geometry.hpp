#pragma once
// Reads only the geometry of a machine, for a scenario that is still being written, without supports, effects or
// cyclograms.

#include <string>

#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {

struct Geometry {
  std::string name;
  MachineModel machine;  ///< mesh, and materials, sensors, displacements, tilts and effects if present; no more
};

/// Reads the keys `name`, `machine`, `materials`, `sensors` and `displacements` of a scenario, and of `effects` those that
/// take a film from a file. It ignores all others, which read_scenario() reads.
/// @param with_effects  reads all effects, and `tilts`
/// @throws InputError
[[nodiscard]] Geometry read_geometry(const std::string& path, bool with_effects = false);

}  // namespace driftwright::scenarios
