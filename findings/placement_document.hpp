#pragma once
// The result of `place`, as a document.

#include "output/document.hpp"
#include "studies/placement.hpp"

namespace driftwright::findings {

[[nodiscard]] output::Document document_of(const studies::Placement& placement, const scenarios::Scenario& scenario,
                                           const std::vector<std::string>& entries, const output::Provenance& made_by);

}  // namespace driftwright::findings
