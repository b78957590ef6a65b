#include <fmt/format.h>

#include "app/film_fields.hpp"
#include "app/results.hpp"
#include "base/file_name.hpp"
#include "findings/machine_study_document.hpp"
#include "findings/plausibility.hpp"
#include "machine/ways_out.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "studies/table_study.hpp"

namespace driftwright::app {

void run(const CommonOptions& options) {
  const scenarios::Scenario scenario = read_scenario(options, Told::kInDocument);
  if (scenario.machine) scenarios::require_nothing_before(*scenario.machine, "run");
  if (scenario.table) return run_table(options, scenario);
  if (scenario.volume) return run_volume(options, scenario);
  const scenarios::MachineModel& model = scenarios::require_machine(scenario, "run");
  (void)scenarios::require_study(scenario, "run");
  for (const Cyclogram& c : scenario.cyclograms) scenarios::require_resting(model.axes, c);
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  const bool wants_fields = scenario.solver.fields_format != FieldsFormat::kNone;
  const scenarios::Model machine = scenarios::open_model(scenario, {}, progress.listener(), wants_fields);
  if (const scenarios::Machine* full = machine.full()) {  // thermal modes need them
    scenarios::require_ways_out(full->placed.mesh, full->placed.balance, model.where);
  }

  std::optional<output::FieldSeries> fields;
  findings::WorstMoment worst;
  if (machine.mesh().n_nodes() > 0 && wants_fields) fields.emplace(folder, machine.mesh(), scenario.solver.fields_format);
  const studies::MachineStudy study =
      studies::study_machine(scenario, machine, progress.listener(), sink_of(fields ? &*fields : nullptr, worst));
  if (fields) {
    fields->finish();
    write_films(model, machine, folder);
  }
  progress.begin("writing results");
  folder.write_text(
      "record.csv",
      record_csv(study.judged.record, provenance_lines(folder.made_by(), "judged cyclogram " + scenario.study->judge)));
  for (const scenarios::SimulatedRun& run : study.train) {
    folder.write_text("records/" + file_name(run.record.source, ".csv"),
                      record_csv(run.record, provenance_lines(folder.made_by(), "training cyclogram " + run.record.source)));
  }
  folder.write_text("heat_flows.csv", heat_flows_csv(study.judged.trajectory, scenario.study->judge, folder.made_by()));
  folder.write_text("schedule.txt", findings::schedule_text(study));
  output::Document document = findings::document_of(study, scenario, machine, worst, folder.made_by());
  std::vector<std::string> unusual = unusual_results(study.train, model);
  for (std::string& sentence : unusual_results({&study.judged, 1}, model)) unusual.push_back(std::move(sentence));
  findings::add_plausibility(document.body, scenario, unusual);
  finish(document, folder, progress, options,
         fmt::format("{}{}{}", machine.was_known ? "the reduced model was known from disk\n" : "",
                     fields ? fmt::format("fields in {} (ParaView)\n", fields->file_to_open()) : "",
                     fields ? fields_note(*fields) : ""));
}

}  // namespace driftwright::app
