#pragma once
// The main job's results for people and programs: the terminal's ten lines, summary.json, report.html.

#include <nlohmann/json_fwd.hpp>

#include "app/results.hpp"
#include "output/html_report.hpp"
#include "studies/machine_study.hpp"

namespace driftwright::app {

/// Ten lines: peak drift before and after each strategy on the cyclogram it was not fitted on.
[[nodiscard]] std::string terminal_summary(const scenarios::Scenario& scenario, const studies::MachineStudy& study);

/// Everything that a script would want, with units in the keys (docs/outputs.md).
[[nodiscard]] nlohmann::ordered_json summary_json(const scenarios::Scenario& scenario, const scenarios::Model& model,
                                                  const studies::MachineStudy& study, const output::Provenance& made_by);

[[nodiscard]] output::Report study_report(const scenarios::Scenario& scenario, const scenarios::Model& model,
                                          const studies::MachineStudy& study, const output::Provenance& made_by);

/// The correction schedules of all channels in the paper's notation, for the person who edits the NC program.
[[nodiscard]] std::string schedule_text(const studies::MachineStudy& study);

}  // namespace driftwright::app
