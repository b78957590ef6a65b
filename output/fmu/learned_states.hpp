#pragma once
// What effects `learned` add to sensors and displacements, as states of a unit.

#include "machine/model.hpp"
#include "output/fmu/fmu_model.hpp"

namespace driftwright::output {

/// Adds the effects `learned` of a machine to its model, whose physics are complete: a state for each lag of each drive,
/// with tau dx/dt = u - x, which outputs share, and for each lag of the ambient, which begins at the ambient; states that
/// keep the ambient and displacements of the start. Terms without a lag are `direct`.
/// @throws InputError  for an effect that follows a recorded column
void add_learned(FmuModel& model, const scenarios::MachineModel& machine);

}  // namespace driftwright::output
