#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/exit_code.hpp"
#include "app/film_fields.hpp"
#include "app/results.hpp"
#include "base/file_name.hpp"
#include "findings/plausibility.hpp"
#include "findings/simulation_document.hpp"
#include "machine/distributable.hpp"
#include "machine/reduced_files.hpp"
#include "solver/on_all_ranks.hpp"
#include "studies/known_band.hpp"
#include "studies/prediction.hpp"

namespace driftwright::app {
namespace {

/// The named cyclograms; all of the scenario if none is named.
/// @throws InputError  for two of one name, whose records would be one file, and as named_cyclogram()
std::vector<Cyclogram> asked_cyclograms(const scenarios::Scenario& scenario, const std::vector<std::string>& names) {
  if (names.empty()) return scenario.cyclograms;
  std::vector<Cyclogram> asked;
  for (std::size_t i = 0; i < names.size(); ++i) {
    asked.push_back(studies::named_cyclogram(scenario, names[i]));
    for (std::size_t k = 0; k < i; ++k) {
      if (asked[k].name == asked[i].name)
        throw InputError(
            fmt::format("--cyclogram {} and --cyclogram {} are both named '{}'; their records would have one name", names[k],
                        names[i], asked[i].name));
    }
  }
  return asked;
}

/// @param ranks  the processes that compute together, of which the first one writes; null: this one alone
void simulate_on(const solver::Ranks* ranks, const SimulateOptions& options) {
  scenarios::Scenario scenario = read_scenario(options, Told::kInDocument);
  (void)scenarios::require_machine(scenario, "simulate");
  const std::vector<Cyclogram> asked = asked_cyclograms(scenario, options.cyclograms);
  for (const std::string& position : options.pose) scenarios::set_pose(scenario.machine->axes, position, asked);
  std::vector<const Cyclogram*> cyclograms;
  for (const Cyclogram& c : asked) cyclograms.push_back(&c);
  if (ranks) scenarios::require_distributable(scenario, cyclograms);
  const bool writes = !ranks || ranks->rank == 0;
  const std::unique_ptr<output::ResultsFolder> results(
      writes ? new output::ResultsFolder(open_results(options, scenario.name)) : nullptr);
  Progress progress(options.quiet || !writes);
  // Whole fields of one cyclogram only: those of several would fill the disk, and one list of times would mix them.
  const bool wants_fields = scenario.solver.fields_format != FieldsFormat::kNone;
  const bool writes_fields = wants_fields && cyclograms.size() == 1;
  const scenarios::Model machine = scenarios::open_model(scenario, cyclograms, progress.listener(), writes_fields, nullptr,
                                                         ranks, scenarios::Follows::kMoves);
  if (!writes) {  // it computes its part of what the first process writes
    scenarios::FieldSink computed{.cyclogram = 0, .take = [](const scenarios::WholeFields&) {}};
    (void)scenarios::simulate_cyclograms(scenario, machine, cyclograms, progress.listener(),
                                         writes_fields ? computed : scenarios::FieldSink{});
    return;
  }
  output::ResultsFolder& folder = *results;
  std::optional<output::FieldSeries> fields;
  findings::WorstMoment worst;
  const bool has_mesh = machine.mesh().n_nodes() > 0;
  if (has_mesh && writes_fields) fields.emplace(folder, machine.mesh(), scenario.solver.fields_format);
  const std::vector<scenarios::SimulatedRun> runs = scenarios::simulate_cyclograms(
      scenario, machine, cyclograms, progress.listener(), sink_of(fields ? &*fields : nullptr, worst));
  if (fields) {
    fields->finish();
    write_films(*scenario.machine, machine, folder);
  }
  std::vector<std::optional<RecordBand>> bands;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const scenarios::SimulatedRun& run = runs[i];
    const std::string& name = cyclograms[i]->name;
    const bool is_only = runs.size() == 1;
    folder.write_text(is_only ? "record.csv" : "records/" + file_name(name, ".csv"),
                      record_csv(run.record, provenance_lines(folder.made_by(), "cyclogram " + name)));
    folder.write_text(is_only ? "heat_flows.csv" : "heat_flows/" + file_name(name, ".csv"),
                      heat_flows_csv(run.trajectory, name, folder.made_by()));
    bands.push_back(studies::known_band(scenario, {machine, *cyclograms[i], scenario.machine->ambient, run.record},
                                        progress.listener()));
    if (bands.back() && !bands.back()->limits.channels.empty())
      folder.write_text(is_only ? "record_band.csv" : "bands/" + file_name(name, ".csv"),
                        band_csv(*bands.back(), folder.made_by()));
  }
  if (const scenarios::ReducedMachine* reduced = machine.reduced(); reduced && !reduced->travel && machine.is_linear()) {
    std::vector<Drive> drives = {Drive{}};
    for (const Cyclogram* c : cyclograms) {
      for (const auto& section : c->sections) {
        if (std::find(drives.begin(), drives.end(), section.drive) == drives.end()) drives.push_back(section.drive);
      }
    }
    scenarios::export_reduced(reduced->system, reduced->start, reduced->error, drives,
                              [&](const std::string& file) { return folder.path("reduced_model/" + file); });
  }
  output::Document document = findings::document_of(runs, cyclograms, scenario, machine, worst, bands, folder.made_by());
  findings::add_plausibility(document.body, scenario, unusual_results(runs, *scenario.machine));
  finish(document, folder, progress, options,
         fmt::format("{}{}{}", machine.was_known ? "the reduced model was known from disk\n" : "",
                     fields                       ? fmt::format("fields in {} (ParaView)\n", fields->file_to_open())
                     : !has_mesh || !wants_fields ? ""
                                                  : "name one cyclogram to get fields, too\n",
                     fields ? fields_note(*fields) : ""));
}

}  // namespace

void simulate(const SimulateOptions& options) {
  if (!options.distributed) return simulate_on(nullptr, options);
  solver::on_all_ranks(
      scenarios::build_name(), [&](const solver::Ranks& ranks) { simulate_on(&ranks, options); },
      [](const std::exception_ptr& failure) { return static_cast<int>(exit_code_of(failure)); });
}

}  // namespace driftwright::app
