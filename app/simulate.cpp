#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/iso230_3_report.hpp"
#include "app/run_report.hpp"
#include "app/verbs.hpp"
#include "machine/reduced_files.hpp"
#include "output/json_text.hpp"
#include "studies/prediction.hpp"

namespace driftwright::app {
namespace {

/// All of the scenario's where none is named.
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

nlohmann::ordered_json summary_json(const scenarios::Model& machine, const std::vector<const Cyclogram*>& cyclograms,
                                    const std::vector<scenarios::SimulatedRun>& runs,
                                    const std::vector<compensation::Iso230Figures>& iso, const output::Provenance& made_by) {
  using Json = nlohmann::ordered_json;
  Json j = {{"program", "driftwright"},
            {"version", made_by.version},
            {"scenario", made_by.scenario},
            {"simulated_by", machine.words()},
            {"cyclograms", Json::array()}};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    Json run = {{"name", cyclograms[i]->name},
                {"duration_min", cyclograms[i]->duration_s() / 60.0},
                {"energy_balance_gap", std::max(1e-16, runs[i].trajectory.energy_gap())},
                {"at_end", Json::array()}};
    for (const Channel& c : runs[i].record.channels) {
      if (c.unit == "um" || c.unit == "urad")
        run["at_end"].push_back({{"name", c.name}, {"unit", c.unit}, {"value", c.values.back()}});
    }
    run["iso_230_3"] = iso230_3_json(iso[i]);
    j["cyclograms"].push_back(run);
  }
  return j;
}

}  // namespace

void simulate(const SimulateOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  const scenarios::MachineModel& model = scenarios::require_machine(scenario, "simulate");
  const std::vector<Cyclogram> asked = asked_cyclograms(scenario, options.cyclograms);
  std::vector<const Cyclogram*> cyclograms;
  for (const Cyclogram& c : asked) cyclograms.push_back(&c);
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress;
  // Whole fields of one cyclogram only: several would fill the disk and mix in one list of times.
  const bool wants_fields = scenario.solver.fields_format != FieldsFormat::kNone;
  const bool writes_fields = wants_fields && cyclograms.size() == 1;
  const scenarios::Model machine = scenarios::open_model(scenario, cyclograms, progress.listener(), writes_fields);
  std::optional<output::FieldSeries> fields;
  const bool has_mesh = machine.mesh().n_nodes() > 0;
  if (has_mesh && writes_fields) fields.emplace(folder, machine.mesh(), scenario.solver.fields_format);
  const std::vector<scenarios::SimulatedRun> runs = scenarios::simulate_cyclograms(
      scenario, machine, cyclograms, progress.listener(), sink_of(fields ? &*fields : nullptr));
  if (fields) fields->finish();
  std::string summary;
  std::vector<compensation::Iso230Figures> iso;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const scenarios::SimulatedRun& run = runs[i];
    const Cyclogram* cyclogram = cyclograms[i];
    iso.push_back(compensation::iso230_3_figures(run.record));
    const std::string file = cyclograms.size() == 1 ? "record.csv" : "records/" + cyclogram->name + ".csv";
    folder.write_text(file, record_csv(run.record, provenance_lines(folder.made_by(), "cyclogram " + cyclogram->name)));
    folder.write_text(cyclograms.size() == 1 ? "heat_flows.csv" : "heat_flows/" + cyclogram->name + ".csv",
                      heat_flows_csv(run.trajectory, cyclogram->name, folder.made_by()));
    summary += fmt::format("{:<20} {:5.0f} min, {} steps; at its end", cyclogram->name, cyclogram->duration_s() / 60.0,
                           run.trajectory.n_steps);
    for (const auto& d : model.displacements)
      summary += fmt::format("  {} {:.1f} um", d.name, run.record.at(d.name).values.back());
    summary += fmt::format("; energy balance {:.0e}; {}\n", std::max(1e-16, run.trajectory.energy_gap()), file);
    if (cyclograms.size() == 1) summary += iso230_3_text(iso.back());
    const std::string overshoot = overshoot_text(run.trajectory, machine);
    if (!overshoot.empty()) summary += "    " + overshoot + "\n";
  }
  if (const scenarios::ReducedMachine* reduced = machine.reduced(); reduced && machine.is_linear()) {
    std::vector<Drive> drives = {Drive{}};
    for (const Cyclogram* c : cyclograms) {
      for (const auto& section : c->sections) {
        if (std::find(drives.begin(), drives.end(), section.drive) == drives.end()) drives.push_back(section.drive);
      }
    }
    scenarios::export_reduced(reduced->system, reduced->start, reduced->error, drives,
                              [&](const std::string& file) { return folder.path("reduced_model/" + file); });
  }
  folder.write_text("summary.json", output::json_text(summary_json(machine, cyclograms, runs, iso, folder.made_by())));
  folder.write_text("report.html",
                    output::render_html(simulation_report(scenario, machine, cyclograms, runs, folder.made_by())));
  folder.commit();
  progress.end();
  fmt::print("{}{}{}\nresults in {}: report.html, summary.json, heat flows in W{}\n{}", summary, machine.words(),
             machine.was_known ? " (known from disk)" : "", shown_path(folder.target()),
             fields                       ? fmt::format(", fields in {} (ParaView)", fields->file_to_open())
             : !has_mesh || !wants_fields ? ""
                                          : "; name one cyclogram to get fields, too",
             fields ? fields_note(*fields) : "");
}

}  // namespace driftwright::app
