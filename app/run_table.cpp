#include <fmt/format.h>

#include "app/film_fields.hpp"
#include "app/results.hpp"
#include "base/quantity.hpp"
#include "compensation/frames/frame_programs.hpp"
#include "findings/plausibility.hpp"
#include "findings/table_document.hpp"
#include "machine/ways_out.hpp"
#include "scenarios/reader/unusual.hpp"

namespace driftwright::app {

namespace {

compensation::FrameProgram frame_program(const scenarios::Scenario& scenario, const studies::TableStudy& study,
                                         const output::Provenance& made_by) {
  const scenarios::TableSettings& s = *scenario.table;
  compensation::FrameProgram program{.frame = study.frame, .control = study.control, .against_dk = s.against_dk};
  for (const scenarios::TableRing& ring : s.rings) program.rings.push_back({ring.name, ring.at_m});
  program.temperature_K = study.course.record.at(s.thermometer).values[study.n_judged - 1] + kZeroCelsius_K;
  program.free_diameter_m = s.probe.free_diameter_m;
  program.ball_diameter_m = s.ball_diameter_m;
  program.probe_tool = s.probe_tool;
  program.feed_mm_min = 6e4 * s.probe.feeds_m_s.front();
  program.velocity_m_s = s.velocity_m_s;
  program.slew = s.slew;
  program.low_m = s.low_m[0];
  program.high_m = s.high_m[0];
  program.most_correction_um = scenario.limits.correction.most_um;
  program.made_by = fmt::format("Driftwright {}, scenario {}", made_by.version, made_by.scenario);
  return program;
}

}  // namespace

void run_table(const CommonOptions& options, const scenarios::Scenario& scenario) {
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  const bool wants_fields = scenario.solver.fields_format != FieldsFormat::kNone;
  const scenarios::Model machine = scenarios::open_model(scenario, {}, progress.listener(), wants_fields);
  if (const scenarios::Machine* full = machine.full())
    scenarios::require_ways_out(full->placed.mesh, full->placed.balance, scenario.machine->where);
  std::optional<output::FieldSeries> fields;
  findings::WorstMoment worst;
  if (wants_fields) fields.emplace(folder, machine.mesh(), scenario.solver.fields_format);
  const studies::TableStudy study =
      studies::study_table(scenario, machine, progress.listener(), sink_of(fields ? &*fields : nullptr, worst));
  if (fields) {
    fields->finish();
    write_films(*scenario.machine, machine, folder);
  }
  progress.begin("writing results");
  const auto comments = [&](const std::string& what) { return provenance_lines(folder.made_by(), what); };
  folder.write_text("record.csv", record_csv(study.course.record, comments("cyclogram " + scenario.table->cyclogram)));
  folder.write_text("strategies.csv",
                    findings::strategies_csv(study, comments("largest position error anywhere on the table")));
  const compensation::FrameProgram program = frame_program(scenario, study, folder.made_by());
  const std::string why_no_program = compensation::why_no_program(program.rings);
  if (why_no_program.empty()) {
    for (const compensation::ProgramFile& file :
         compensation::frame_programs(compensation::in_machine(program, scenario.table->origin_m)))
      folder.write_text("control/" + file.name, file.text);
  }
  output::Document document = findings::document_of(study, scenario, machine.mesh(), worst, folder.made_by());
  findings::add_plausibility(document.body, scenario, scenarios::unusual_values(study.course.record));
  std::vector<std::string> warnings;
  if (!why_no_program.empty()) warnings.push_back("no programs for controls: " + why_no_program);
  add(document.body, output::Notes{.key = "warnings", .sort = "warning", .lines = warnings});
  finish(document, folder, progress, options,
         fmt::format("{}{}{}", machine.was_known ? "the reduced model was known from disk\n" : "",
                     fields ? fmt::format("fields in {} (ParaView)\n", fields->file_to_open()) : "",
                     fields ? fields_note(*fields) : ""));
}

}  // namespace driftwright::app
