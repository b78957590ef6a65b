#pragma once
// What several verbs do with their results in the same way.

#include <string>

#include "app/progress.hpp"
#include "app/verbs.hpp"
#include "output/results_folder.hpp"
#include "output/vtk_fields.hpp"
#include "scenarios/machine.hpp"

namespace driftwright::app {

/// The folder of results of a command on a scenario.
[[nodiscard]] output::ResultsFolder open_results(const CommonOptions& options, const std::string& scenario_name);

/// Comment lines of a record CSV: who made it from what.
[[nodiscard]] std::vector<std::string> provenance_lines(const output::Provenance& made_by, const std::string& what);

/// A path as the user would type it: relative to the current folder where it lies below it.
[[nodiscard]] std::string shown_path(const std::filesystem::path& path);

/// The scenario's machine, or an InputError that says that the verb needs one.
[[nodiscard]] const scenarios::MachineModel& require_machine(const scenarios::Scenario& scenario, const std::string& verb);
[[nodiscard]] const scenarios::Study& require_study(const scenarios::Scenario& scenario, const std::string& verb);

/// A simulated cyclogram.
struct SimulatedRun {
  Record record;
  solver::Trajectory trajectory;
};

/// Runs one cyclogram from the reference temperature on, with a progress line.
/// @param fields  where whole fields are written every `fields_every`, and at the end; or nullptr
[[nodiscard]] SimulatedRun simulate_cyclogram(const scenarios::Scenario& scenario, const scenarios::Machine& machine,
                                              const Cyclogram& cyclogram, Progress& progress, output::FieldSeries* fields);

}  // namespace driftwright::app
