#pragma once
// Reduced machines kept on disk, by content: a known machine with a new cyclogram needs no finite elements at all.
//
// A machine's folder is named after a hash of its key: everything that decides the result, as text. The key itself stands in the
// folder and is compared, so a machine is never taken for another. Nothing depends on what was run before.

#include <filesystem>
#include <functional>
#include <optional>

#include "scenarios/reduced_machine.hpp"

namespace driftwright::scenarios {

/// What decides mesh, matrices and start: the scenario's keys about them, the bytes of its mesh file, the structure of its heat
/// balance. Laws and their numbers do not count: machines that differ in them alone share one reduced model, whose plan spans them.
/// @throws InputError  when the mesh file cannot be read
[[nodiscard]] std::string machine_text(const MachineModel& model);

/// What decides a reduced machine: its text, the plan, the version of the program; where a steady start or modal predictors come of
/// them, the numbers of laws (of a linear machine its coefficients at standstill), and where something is frozen in the hall's first
/// temperature, that.
[[nodiscard]] std::string machine_key(const MachineModel& model, const ReductionPlan& plan, const std::string& version);

/// $XDG_CACHE_HOME/driftwright, or ~/.cache/driftwright; empty where the environment names neither: then nothing is kept.
[[nodiscard]] std::filesystem::path machine_store();

/// The machine of this key with the laws of this balance, or none. A folder that cannot be read counts as none.
/// @param balance  of the scenario, as effects::heat_balance() gives it
[[nodiscard]] std::optional<ReducedMachine> load_machine(const std::filesystem::path& store, const std::string& key,
                                                         const effects::HeatBalance& balance);

/// Keeps a machine. Other processes see it whole or not at all. @throws InputError  when it cannot be written
void save_machine(const std::filesystem::path& store, const std::string& key, const ReducedMachine& machine);

/// Writes the small system for others: its matrices as .npy, names and numbers in model.json, and reduced_model.py, which reads them
/// and makes A, B, C of dz/dt = A z + B u, y = C z (docs/reduced_model.md).
///
/// @param drives  at which coefficients and powers are written out; laws that look at temperatures must not stand in the system
/// @param file    where the file of a name goes
void export_reduced(const solver::ReducedSystem& system, const Eigen::VectorXd& start, const solver::ReductionError& error,
                    const std::vector<Drive>& drives, const std::function<std::filesystem::path(const std::string&)>& file);

}  // namespace driftwright::scenarios
