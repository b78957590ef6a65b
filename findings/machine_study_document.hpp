#pragma once
// The result of `run` for a machine, as a document.

#include "findings/machine_section.hpp"
#include "output/document.hpp"
#include "studies/machine_study.hpp"

namespace driftwright::findings {

[[nodiscard]] output::Document document_of(const studies::MachineStudy& study, const scenarios::Scenario& scenario,
                                           const scenarios::Model& model, const WorstMoment& worst,
                                           const output::Provenance& made_by);

/// The correction schedules of all channels in the paper's notation, for the person who edits the NC program.
[[nodiscard]] std::string schedule_text(const studies::MachineStudy& study);

}  // namespace driftwright::findings
