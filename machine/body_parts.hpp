#pragma once
// What each region and each lumped node is of a machine's matrices.

#include "machine/machine.hpp"

namespace driftwright::scenarios {

/// Regions of the mesh in its order, then lumped nodes; displacements by sensitivities add the surfaces they look at.
/// @param machine    with elasticity, where displacements of a mesh are outputs
/// @param materials  without curves
[[nodiscard]] std::vector<solver::BodyPart<solver::SparseRow>> body_parts(const MachineModel& model, const Machine& machine,
                                                                          const solver::RegionMaterials& materials,
                                                                          const effects::HeatBalance& balance);

}  // namespace driftwright::scenarios
