#pragma once
// Can heat reach and leave every part of the machine?

#include "base/errors.hpp"
#include "effects/heat_balance.hpp"
#include "mesh/mesh.hpp"

namespace driftwright::scenarios {

/// Looks, without any matrix, whether from each part heat can reach the ambient or a prescribed temperature at standstill: through
/// cells, contacts, films, links and radiation whose coefficient is not zero there. Steady states and thermal modes want it.
/// @throws InputError  at `where`, naming the regions or nodes that cannot
void require_ways_out(const mesh::Mesh& mesh, const effects::HeatBalance& balance, const Where& where);

/// Looks whether each part has any exchange or source of heat at all; one that has none keeps its temperature for ever, which
/// nobody means. @throws InputError  at `where`, naming the regions or nodes
void require_reached(const mesh::Mesh& mesh, const effects::HeatBalance& balance, const Where& where);

}  // namespace driftwright::scenarios
