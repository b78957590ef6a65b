#pragma once
// The result of `mesh --convergence`, as a document.

#include "output/document.hpp"
#include "studies/mesh_convergence.hpp"

namespace driftwright::findings {

[[nodiscard]] output::Document document_of(const studies::MeshConvergence& found, const scenarios::Scenario& scenario,
                                           const output::Provenance& made_by);

}  // namespace driftwright::findings
