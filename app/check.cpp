#include <fmt/format.h>

#include <algorithm>

#include "app/results.hpp"
#include "app/verbs.hpp"
#include "mesh/quality.hpp"

namespace driftwright::app {

namespace {

void print_cyclogram(const Cyclogram& cyclogram) {
  double highest_rpm = 0.0, turning_s = 0.0;
  for (const Cyclogram::Section& section : cyclogram.sections) {
    highest_rpm = std::max(highest_rpm, section.drive.speed_rpm);
    if (section.drive.speed_rpm > 0.0) turning_s += section.duration_s;
  }
  fmt::print("  {:<20} {:7.1f} min in {} section{}, up to {:.0f} rpm, turning {:.0f} % of the time\n", cyclogram.name,
             cyclogram.duration_s() / 60.0, cyclogram.sections.size(), cyclogram.sections.size() == 1 ? "" : "s",
             highest_rpm, 100.0 * turning_s / cyclogram.duration_s());
  for (const std::string& remark : cyclogram.remarks) fmt::print("    {}\n", remark);
}

/// How the records are read that verbs are given.
void print_columns(const scenarios::Scenario& scenario) {
  if (!scenario.columns) return;
  fmt::print("  records are read by `columns`:\n");
  for (const std::string& line : words(*scenario.columns)) fmt::print("    {}\n", line);
}

}  // namespace

void check(const CommonOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  if (!scenario.machine) {
    fmt::print("{}: fine; a study of measured records, target {}\n", options.scenario, scenario.study->target);
    print_columns(scenario);
    return;
  }
  Progress progress;
  progress.begin("meshing");
  const scenarios::PlacedMachine placed = scenarios::place(*scenario.machine);
  progress.end();
  if (placed.mesh.n_nodes() == 0) {
    fmt::print("{}: fine; {} lumped nodes, {} effects, {} sensors, {} cyclograms\n", options.scenario,
               placed.balance.nodes.size(), scenario.machine->effects.size(), scenario.machine->sensors.size(),
               scenario.cyclograms.size());
    for (const Cyclogram& cyclogram : scenario.cyclograms) print_cyclogram(cyclogram);
    print_columns(scenario);
    return;
  }
  const mesh::Quality quality = mesh::worst_quality(placed.mesh);
  fmt::print(
      "{}: fine; {} nodes, {} cells in {} regions, {} joints, {} effects, {} sensors, {} cyclograms; worst "
      "scaled Jacobian {:.3f}\n",
      options.scenario, placed.mesh.n_nodes(), placed.mesh.cells.size(), placed.mesh.regions.size(),
      placed.mesh.joints.size(), scenario.machine->effects.size(), scenario.machine->sensors.size(),
      scenario.cyclograms.size(), quality.min_scaled);
  for (const Cyclogram& cyclogram : scenario.cyclograms) print_cyclogram(cyclogram);
  print_columns(scenario);
  for (const std::string& note : placed.mesh.notes) fmt::print("note: {}\n", note);
}

}  // namespace driftwright::app
