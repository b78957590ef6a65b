#include <fmt/format.h>

#include <cstdio>

#include "app/diagnosis_files.hpp"
#include "app/end_request.hpp"
#include "app/results.hpp"
#include "findings/diagnosis_document.hpp"
#include "studies/measured_diagnosis.hpp"

namespace driftwright::app {

void diagnose(const DiagnoseOptions& options) {
  const scenarios::Scenario scenario = read_scenario(options);
  (void)scenarios::require_machine(scenario, "diagnose");
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  const studies::MeasuredTwin m =
      studies::open_measured_twin(scenario, "diagnose", options.measured, progress.listener(), options.as_recorded);
  Listener listener = progress.listener();
  listener.wants_end_now = EndRequest::is_made;
  const EndRequest end_request;  // until all results are written: Ctrl-C cuts no file short
  const auto [d, written] = studies::diagnose(
      m, {.without = options.without, .causes_only = options.causes_only, .file = folder.target() / "extended.yaml"},
      listener);
  write_scenario("extended", written, folder);
  write_missing_heat(m.mesh, d.statements, folder);
  const studies::Remainder remainder = studies::remainder_of(m, d, written, listener);
  finish(findings::diagnosis_document({m, d, written.extended, written.difference, "extended.yaml", &remainder},
                                      folder.made_by()),
         folder, progress, options, "", "diagnosis.json");
  std::fflush(stdout);
  if (!d.ended_at.empty()) throw EndedEarly(fmt::format("ended at \"{}\": the diagnosis is incomplete", d.ended_at));
  if (EndRequest::is_made()) fmt::print(stderr, "the diagnosis was complete; all of its results are written\n");
}

}  // namespace driftwright::app
