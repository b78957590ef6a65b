#pragma once
// Which scenarios several processes can simulate together (solver/share.hpp).

#include <vector>

#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {

/// Looks at the scenario alone, before any work.
/// @throws InputError  naming what only one process can compute: a reduced model, a machine without a mesh, moving axes, a
///                     steady start, prescribed temperatures, films of a file
void require_distributable(const Scenario& scenario, const std::vector<const Cyclogram*>& cyclograms);

}  // namespace driftwright::scenarios
