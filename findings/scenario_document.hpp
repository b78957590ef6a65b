#pragma once
// The results of `check`, `mesh` and `list`, as documents.

#include <span>

#include "machine/machine.hpp"
#include "machine/mesh_demand.hpp"
#include "output/document.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::findings {

/// The contents of a scenario that can be run, and the resources it will need. @param placed, demand null: a study of
/// measured records
[[nodiscard]] output::Document scenario_document(const scenarios::Scenario& scenario, const scenarios::PlacedMachine* placed,
                                                 const scenarios::MeshDemand* demand, const output::Provenance& made_by);

/// Size and quality of a mesh, its regions, surfaces and joints. @param machine  source of marks and masses, if it has them
/// @param films  that files have on it
[[nodiscard]] output::Document mesh_document(const std::string& name, const scenarios::MachineModel& machine,
                                             const mesh::Mesh& mesh, std::span<const scenarios::MappedFilm> films,
                                             const output::Provenance& made_by);

/// The cyclograms of a scenario, and the joints of a mesh, as `list` shows them.
[[nodiscard]] output::Document cyclograms_document(const scenarios::Scenario& scenario, const output::Provenance& made_by);
[[nodiscard]] output::Document joints_document(const std::string& name, const mesh::Mesh& mesh,
                                               const output::Provenance& made_by);

}  // namespace driftwright::findings
