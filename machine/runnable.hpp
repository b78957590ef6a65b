#pragma once
// Would a scenario run? What the solvers would refuse, looked for without a factorisation.

#include "machine/machine.hpp"

namespace driftwright::scenarios {

/// Looks whether supports and joints hold every part where displacements are asked for, and whether heat can leave every part where a steady state, a reduced model or
/// thermal modes want it. @throws InputError  as simulating would
void require_runnable(const Scenario& scenario, const PlacedMachine& placed);

/// An error of the elastic machine, which knows what is wrong, with where that stands in the scenario.
[[nodiscard]] InputError located(const MachineModel& model, const InputError& e);

}  // namespace driftwright::scenarios
