#pragma once
// A scenario as `check` and its mesh as `mesh` show it, as documents.

#include "machine/machine.hpp"
#include "output/document.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::findings {

/// What is in a scenario that can be run. @param placed  null: a study of measured records
[[nodiscard]] output::Document scenario_document(const scenarios::Scenario& scenario, const scenarios::PlacedMachine* placed,
                                                 const output::Provenance& made_by);

/// Size and quality of a mesh, its regions, surfaces and joints.
[[nodiscard]] output::Document mesh_document(const scenarios::Scenario& scenario, const scenarios::PlacedMachine& placed,
                                             const output::Provenance& made_by);

}  // namespace driftwright::findings
