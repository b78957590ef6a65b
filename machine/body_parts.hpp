#pragma once
// The contribution of each region and each lumped node to a machine's matrices.

#include "machine/machine.hpp"

namespace driftwright::scenarios {

/// The regions of the mesh in its order, then the lumped nodes. Displacements with sensitivities to a surface add that
/// surface.
/// @param machine    with elasticity, where displacements of a mesh are outputs
/// @param materials  without curves
[[nodiscard]] std::vector<solver::BodyPart<solver::SparseRow>> body_parts(const MachineModel& model, const Machine& machine,
                                                                          const solver::RegionMaterials& materials,
                                                                          const effects::HeatBalance& balance);

}  // namespace driftwright::scenarios
