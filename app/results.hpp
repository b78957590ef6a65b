#pragma once
// What several verbs do with their results in the same way.

#include <string>

#include "app/progress.hpp"
#include "app/verbs.hpp"
#include "findings/machine_section.hpp"
#include "machine/simulated_run.hpp"
#include "output/document.hpp"
#include "output/field_series.hpp"
#include "output/results_folder.hpp"

namespace driftwright::app {

/// Who warns of numbers that no machine has (scenarios/reader/unusual.hpp): the document of results, or standard error at once.
enum class Told { kInDocument, kAtOnce };

/// The scenario that a verb is given. @throws InputError  with --strict, for numbers that no machine has
[[nodiscard]] scenarios::Scenario read_scenario(const CommonOptions& options, Told told = Told::kAtOnce);

/// The folder of results of a command on a scenario.
[[nodiscard]] output::ResultsFolder open_results(const CommonOptions& options, const std::string& scenario_name);

/// Where that folder will be, for work that keeps pieces beside it. @throws InputError  where it may not be
[[nodiscard]] std::filesystem::path checked_results(const CommonOptions& options, const std::string& scenario_name);

/// Writes a document's renderings (report.html, tables and its JSON) into the folder, puts that in place, and shows the document.
/// @throws InputError  with --strict, for a document that warns of what no machine does; the folder is not put in place then
/// @param also  lines for the terminal alone, such as what was known from disk
/// @param json_file  another name of the JSON, beside summary.json
void finish(const output::Document& document, output::ResultsFolder& folder, Progress& progress,
            const CommonOptions& options, const std::string& also = "", const std::string& json_file = "summary.json");

/// @throws InputError  for a document that warns of what no machine has or does
void refuse_implausible(const std::string& scenario_path, const output::Document& document);

/// Prints a document as the options want it.
void show(const output::Document& document, const CommonOptions& options);

/// Comment lines of a record CSV: who made it from what.
[[nodiscard]] std::vector<std::string> provenance_lines(const output::Provenance& made_by, const std::string& what);

/// Text of heat_flows.csv of a run.
[[nodiscard]] std::string heat_flows_csv(const solver::Trajectory& run, const std::string& cyclogram,
                                         const output::Provenance& made_by);

/// A path as the user would type it: relative to the current folder where it lies below it.
[[nodiscard]] std::string shown_path(const std::filesystem::path& path);

/// What the terminal says of a series too long for its format, a line of its own; empty otherwise.
[[nodiscard]] std::string fields_note(const output::FieldSeries& fields);

/// Writes whole fields of the first cyclogram to a series and lets `worst` see them; both outlive the sink. @param fields  null: nobody wants any
[[nodiscard]] scenarios::FieldSink sink_of(output::FieldSeries* fields, findings::WorstMoment& worst);

}  // namespace driftwright::app
