#pragma once
// Everything that determines a reduced machine, as text: equal texts mean equal machines.

#include "machine/reduced_machine.hpp"

namespace driftwright::scenarios {

/// What determines mesh, matrices and start: the scenario's keys about them, the bytes of its mesh file, the structure of
/// its heat balance, factors on materials. Laws and their numbers are not included, nor errors of drive and instruments:
/// machines that differ only in these share one reduced model, whose plan covers them.
/// @throws InputError  when the mesh file cannot be read
[[nodiscard]] std::string machine_text(const MachineModel& model);

/// What determines a reduced machine: its text, the plan and the program's version. If a steady start or modal predictors
/// depend on them, also the numbers of laws (of a linear machine: its coefficients at standstill). If something is frozen at
/// the first ambient temperature, also that temperature.
[[nodiscard]] std::string machine_key(const MachineModel& model, const ReductionPlan& plan, const std::string& version);

}  // namespace driftwright::scenarios
