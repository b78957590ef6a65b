#pragma once
// What several verbs do with their results in the same way.

#include <string>

#include "app/model.hpp"
#include "app/progress.hpp"
#include "app/verbs.hpp"
#include "output/field_series.hpp"
#include "output/results_folder.hpp"
#include "machine/machine.hpp"

namespace driftwright::app {

/// The folder of results of a command on a scenario.
[[nodiscard]] output::ResultsFolder open_results(const CommonOptions& options, const std::string& scenario_name);

/// Comment lines of a record CSV: who made it from what.
[[nodiscard]] std::vector<std::string> provenance_lines(const output::Provenance& made_by, const std::string& what);

/// Text of heat_flows.csv of a run.
[[nodiscard]] std::string heat_flows_csv(const solver::Trajectory& run, const std::string& cyclogram,
                                         const output::Provenance& made_by);

/// A path as the user would type it: relative to the current folder where it lies below it.
[[nodiscard]] std::string shown_path(const std::filesystem::path& path);

/// The scenario's machine, or an InputError that says that the verb needs one.
[[nodiscard]] const scenarios::MachineModel& require_machine(const scenarios::Scenario& scenario, const std::string& verb);
[[nodiscard]] const scenarios::Study& require_study(const scenarios::Scenario& scenario, const std::string& verb);

/// What the terminal says of a series too long for its format, a line of its own; empty otherwise.
[[nodiscard]] std::string fields_note(const output::FieldSeries& fields);

/// A simulated cyclogram.
struct SimulatedRun {
  Record record;
  solver::Trajectory trajectory;
};

/// Runs one cyclogram.
/// @param machine   the scenario's, or one that differs from it in the hall
/// @param from      state of the model at t = 0
/// @param times_s   of the outputs, within the cyclogram
/// @param at_output called at each of them
[[nodiscard]] SimulatedRun simulate_run(const scenarios::MachineModel& machine, const solver::TransientOptions& options,
                                        const Model& model, const Eigen::VectorXd& from, const Cyclogram& cyclogram,
                                        const std::vector<double>& times_s, const solver::OutputCallback& at_output = {});

/// The state of the model at t = 0, by the scenario's `start`, over the reference temperature [K]; reduced for a reduced model.
[[nodiscard]] Eigen::VectorXd start_of(const scenarios::MachineModel& machine, const Model& model);
/// The state "1 K warmer everywhere".
[[nodiscard]] const Eigen::VectorXd& ones_of(const Model& model);

/// Runs cyclograms from the scenario's start on, side by side on all cores, with one progress line for all.
/// @param with_fields  index of the cyclogram whose whole fields go to `fields` every `fields_every` and at its end
/// @param fields       or nullptr
[[nodiscard]] std::vector<SimulatedRun> simulate_cyclograms(const scenarios::Scenario& scenario, const Model& model,
                                                            const std::vector<const Cyclogram*>& cyclograms,
                                                            Progress& progress, std::size_t with_fields,
                                                            output::FieldSeries* fields);

}  // namespace driftwright::app
