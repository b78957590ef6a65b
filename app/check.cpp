#include <fmt/format.h>

#include "app/results.hpp"
#include "base/delimited_text.hpp"
#include "base/version.hpp"
#include "findings/plausibility.hpp"
#include "findings/scenario_document.hpp"
#include "machine/mesh_demand.hpp"
#include "machine/runnable.hpp"
#include "machine/simulated_run.hpp"

namespace driftwright::app {
namespace {

/// Runs the cyclograms of a machine of lumped nodes, which takes a moment, and returns sentences about what no machine
/// does.
std::vector<std::string> unusual_in_runs(scenarios::Scenario scenario, const Listener& listener) {
  scenario.solver.model = scenarios::ModelKind::kFull;
  std::vector<std::string> found;
  const scenarios::Model model = scenarios::open_model(scenario, {}, listener, false);
  for (const Cyclogram& cyclogram : scenario.cyclograms) {
    try {
      const auto runs = scenarios::simulate_cyclograms(scenario, model, {&cyclogram}, listener);
      for (std::string& sentence : scenarios::unusual_results(runs, *scenario.machine)) found.push_back(std::move(sentence));
    } catch (const SolveError& e) {
      found.push_back(fmt::format("cannot be run: {}", e.what()));
    } catch (const InputError&) {  // it requires a column that this cyclogram lacks; the error appears when the user runs it
    }
  }
  return found;
}

}  // namespace

void check(const CommonOptions& options) {
  const scenarios::Scenario scenario = read_scenario(options, Told::kInDocument);
  std::optional<scenarios::PlacedMachine> placed;
  std::optional<scenarios::MeshDemand> demand;
  Progress progress(options.quiet);
  progress.begin("meshing");
  if (scenario.machine) {
    placed = scenarios::place(*scenario.machine);
    scenarios::require_runnable(scenario, *placed);
    progress.begin("counting what it will take");
    demand = scenarios::mesh_demand(scenario, *placed, scenario.solver.model == scenarios::ModelKind::kFull);
    scenarios::require_room(scenario, *placed, *demand, scenarios::room_bytes());
  }
  std::vector<std::string> unusual;
  if (placed && placed->mesh.n_nodes() == 0) unusual = unusual_in_runs(scenario, progress.listener());
  progress.end();
  output::Document document = findings::scenario_document(scenario, placed ? &*placed : nullptr, demand ? &*demand : nullptr,
                                                          {kVersion, clean_name(options.scenario)});
  findings::add_plausibility(document.body, scenario, unusual);
  if (!findings::implausible(document).empty())
    document.title = clean_name(options.scenario) + ": can be run, but is not plausible";
  if (options.strict) refuse_implausible(options.scenario, document);
  show(document, options);
}

}  // namespace driftwright::app
