#pragma once
// What decides a reduced machine, as text: machines of the same text are the same.

#include "machine/reduced_machine.hpp"

namespace driftwright::scenarios {

/// What decides mesh, matrices and start: the scenario's keys about them, the bytes of its mesh file, the structure of its heat
/// balance, factors on materials. Laws and their numbers do not count, nor do errors of drive and instruments: machines that differ in
/// them alone share one reduced model, whose plan spans them.
/// @throws InputError  when the mesh file cannot be read
[[nodiscard]] std::string machine_text(const MachineModel& model);

/// What decides a reduced machine: its text, the plan, the version of the program; where a steady start or modal predictors come of
/// them, the numbers of laws (of a linear machine its coefficients at standstill), and where something is frozen in the ambient's first
/// temperature, that.
[[nodiscard]] std::string machine_key(const MachineModel& model, const ReductionPlan& plan, const std::string& version);

}  // namespace driftwright::scenarios
