#include "app/results.hpp"
#include "base/delimited_text.hpp"
#include "base/version.hpp"
#include "findings/scenario_document.hpp"
#include "machine/runnable.hpp"

namespace driftwright::app {

void check(const CommonOptions& options) {
  const scenarios::Scenario scenario = scenarios::read_scenario(options.scenario);
  std::optional<scenarios::PlacedMachine> placed;
  Progress progress(options.quiet);
  progress.begin("meshing");
  if (scenario.machine) {
    placed = scenarios::place(*scenario.machine);
    scenarios::require_runnable(scenario, *placed);
  }
  progress.end();
  show(findings::scenario_document(scenario, placed ? &*placed : nullptr, {kVersion, clean_name(options.scenario)}), options);
}

}  // namespace driftwright::app
