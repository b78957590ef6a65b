#pragma once
// The result of `run` for a scenario with a volume, as a document.

#include "output/document.hpp"
#include "studies/work_volume.hpp"

namespace driftwright::findings {

[[nodiscard]] output::Document document_of(const studies::WorkVolume& volume, const scenarios::Scenario& scenario,
                                           const scenarios::Model& model, const output::Provenance& made_by);

}  // namespace driftwright::findings
