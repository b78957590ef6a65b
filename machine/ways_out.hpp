#pragma once
// Checks whether heat can reach and leave every part of the machine.

#include "base/errors.hpp"
#include "effects/heat_balance.hpp"
#include "mesh/mesh.hpp"

namespace driftwright::scenarios {

/// Checks, without any matrix, whether heat from each part can reach the ambient or a prescribed temperature at standstill:
/// through cells, contacts, films, links and radiation whose coefficient is not zero there. Steady states and thermal modes
/// require this.
/// @throws InputError  at `where`, naming the regions or nodes from which it cannot
void require_ways_out(const mesh::Mesh& mesh, const effects::HeatBalance& balance, const Where& where);

/// Checks whether each part has any exchange or source of heat at all. A part without one keeps its temperature forever,
/// which is never intended. @throws InputError at `where`, naming the regions or nodes
void require_reached(const mesh::Mesh& mesh, const effects::HeatBalance& balance, const Where& where);

}  // namespace driftwright::scenarios
