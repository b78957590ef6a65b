#pragma once
// The result of `simulate`, as a document.

#include "base/record_band.hpp"
#include "findings/machine_section.hpp"
#include "machine/simulated_run.hpp"
#include "output/document.hpp"

namespace driftwright::findings {

/// @param runs, bands  of the cyclograms, in their order
[[nodiscard]] output::Document document_of(const std::vector<scenarios::SimulatedRun>& runs,
                                           const std::vector<const Cyclogram*>& cyclograms,
                                           const scenarios::Scenario& scenario, const scenarios::Model& model,
                                           const WorstMoment& worst, const std::vector<std::optional<RecordBand>>& bands,
                                           const output::Provenance& made_by);

}  // namespace driftwright::findings
