#pragma once
// Surfaces along which a liquid flows, cut into the sections that an effect names by a line (effects/flow_path.hpp).

#include "mesh/mesh.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {

/// Adds a surface of the mesh for each section of each channel of the model: the facets whose middle is nearest to that part
/// of the line. The surface itself keeps its facets, so they are in the mesh twice.
/// @throws InputError  for a section without facet, and where two channels cut a surface differently
/// Surfaces that the mesh lacks are left to check_effects().
void add_channel_sections(const MachineModel& model, mesh::Mesh& mesh);

}  // namespace driftwright::scenarios
