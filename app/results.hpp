#pragma once
// Steps that several verbs share: reading the scenario, opening the folder of results, writing and showing the document.

#include <functional>
#include <string>

#include "app/progress.hpp"
#include "app/verbs.hpp"
#include "base/record_band.hpp"
#include "findings/machine_section.hpp"
#include "machine/simulated_run.hpp"
#include "output/document.hpp"
#include "output/field_series.hpp"
#include "output/results_folder.hpp"

namespace driftwright::app {

/// Where warnings about numbers that no machine has (scenarios/reader/unusual.hpp) go: the document of results, or
/// standard error at once.
enum class Told { kInDocument, kAtOnce };

/// Reads the scenario of a verb. @throws InputError  with --strict, for numbers that no machine has
[[nodiscard]] scenarios::Scenario read_scenario(const CommonOptions& options, Told told = Told::kAtOnce);

/// The folder of results of a command on a scenario.
[[nodiscard]] output::ResultsFolder open_results(const CommonOptions& options, const std::string& scenario_name);

/// The path of that folder, for work that keeps pieces beside it. @throws InputError  if the folder may not be used
[[nodiscard]] std::filesystem::path checked_results(const CommonOptions& options, const std::string& scenario_name);

/// Writes a document's renderings (report.html, tables and its JSON) into the folder, commits the folder, and shows the
/// document.
/// @throws InputError  with --strict, for a document with warnings about what no machine does; the folder is not
/// committed then
/// @param also  lines for the terminal only, such as what was read from disk
/// @param json_file  another name of the JSON, beside summary.json
void finish(const output::Document& document, output::ResultsFolder& folder, Progress& progress,
            const CommonOptions& options, const std::string& also = "", const std::string& json_file = "summary.json");

/// @throws InputError  for a document that warns of what no machine has or does
void refuse_implausible(const std::string& scenario_path, const output::Document& document);

/// Writes one file beside its place, then puts it there: it is whole or not there. @param write  to the path that it gets
/// @throws InputError  naming -o, if that fails
void write_whole(const std::filesystem::path& target, const std::function<void(const std::filesystem::path&)>& write);

/// Prints a document as the options say.
void show(const output::Document& document, const CommonOptions& options);

/// Comment lines of a record CSV: who made it from what.
[[nodiscard]] std::vector<std::string> provenance_lines(const output::Provenance& made_by, const std::string& what);

/// Text of heat_flows.csv of a run.
[[nodiscard]] std::string heat_flows_csv(const solver::Trajectory& run, const std::string& cyclogram,
                                         const output::Provenance& made_by);

/// Text of the CSV of a band: a record whose channels are the limits, `<name>_low` and `<name>_high`.
[[nodiscard]] std::string band_csv(const RecordBand& band, const output::Provenance& made_by);

/// A path as the user would type it: relative to the current folder if it lies below it.
[[nodiscard]] std::string shown_path(const std::filesystem::path& path);

/// The terminal's line about a series that is too long for its format; empty otherwise.
[[nodiscard]] std::string fields_note(const output::FieldSeries& fields);

/// Writes the whole fields of the first cyclogram to a series and passes them to `worst`; both must outlive the sink.
/// @param fields  null: no fields are written
[[nodiscard]] scenarios::FieldSink sink_of(output::FieldSeries* fields, findings::WorstMoment& worst);

}  // namespace driftwright::app
