#include "findings/simulation_document.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "findings/iso230_3_section.hpp"
#include "findings/named_value.hpp"
#include "findings/run_section.hpp"

namespace driftwright::findings {
namespace {

output::Table end_table(const Record& record) {
  output::Table table{
      .key = "at_end",
      .columns = {
          {.key = "name", .title = "at its end"}, {.key = "unit", .title = "unit"}, {.key = "value", .title = "value"}}};
  for (const Channel& c : record.channels) {
    if (c.unit == "um" || c.unit == "urad") table.rows.push_back({c.name, c.unit, c.values.back()});
  }
  return table;
}

}  // namespace

output::Document document_of(const std::vector<scenarios::SimulatedRun>& runs,
                             const std::vector<const Cyclogram*>& cyclograms, const scenarios::Scenario& scenario,
                             const scenarios::Model& model, const WorstMoment& worst,
                             const std::vector<std::optional<RecordBand>>& bands, const output::Provenance& made_by) {
  output::Document document{.made_by = made_by,
                            .title = scenario.name + ": simulation",
                            .subtitle = fmt::format("{} nodes, {} cells, {} lumped nodes; {}", model.mesh().n_nodes(),
                                                    model.mesh().cells.size(), model.balance.nodes.size(), model.words())};
  add(document.body, output::Value{.key = "simulated_by", .datum = model.words()});
  add_machine(document.body, *scenario.machine, model.mesh(), cyclograms.front()->name, worst);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Cyclogram& cyclogram = *cyclograms[i];
    const solver::Trajectory& run = runs[i].trajectory;
    output::Section section{
        .key = "cyclograms", .title = "Cyclogram " + cyclogram.name, .item = output::Item{"cyclogram", cyclogram.name}};
    add(section, named_value("duration_min", "duration", cyclogram.duration_s() / 60.0, "min", output::decimals(0)));
    add(section, output::Value{.key = "n_steps", .words = "steps", .datum = run.n_steps});
    add(section, named_value("energy_balance_gap", "gap of the energy balance", std::max(1e-16, run.energy_gap()),
                             output::scientific(0)));
    add(section, end_table(runs[i].record));
    add_overshoots(section, run, model);
    add_channel_plots(section, runs[i].record, cyclogram, bands[i] ? &*bands[i] : nullptr);
    add_heat(section, run, cyclogram);
    section.sections.push_back(iso230_3_section(compensation::iso230_3_figures(runs[i].record)));
    section.sections.back().detail = runs.size() > 1;
    document.body.sections.push_back(std::move(section));
  }
  return document;
}

}  // namespace driftwright::findings
