#pragma once
// Checks whether a scenario can run: finds what the solvers would refuse, without a factorisation.

#include "machine/machine.hpp"

namespace driftwright::scenarios {

/// Checks that supports and joints hold every part if displacements are requested, that heat can leave every part if a
/// steady state, a reduced model or thermal modes are needed, and that tool and work of a `volume` exist.
/// @throws InputError  the same as a simulation would throw
void require_runnable(const Scenario& scenario, const PlacedMachine& placed);

/// Adds the position in the scenario to an error of the elastic machine.
[[nodiscard]] InputError located(const MachineModel& model, const InputError& e);

}  // namespace driftwright::scenarios
