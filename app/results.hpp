#pragma once
// What several verbs do with their results in the same way.

#include <string>

#include "app/progress.hpp"
#include "app/verbs.hpp"
#include "machine/simulated_run.hpp"
#include "output/field_series.hpp"
#include "output/results_folder.hpp"

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

/// What the terminal says of a series too long for its format, a line of its own; empty otherwise.
[[nodiscard]] std::string fields_note(const output::FieldSeries& fields);

/// Writes whole fields of one cyclogram, the first unless told, to a series. @param fields  null: nobody wants any
[[nodiscard]] scenarios::FieldSink sink_of(output::FieldSeries* fields, std::size_t cyclogram = 0);

}  // namespace driftwright::app
