#pragma once
// The stiffness matrix type of an elastic body.

#include "solver/block_rows.hpp"

namespace driftwright::solver {

/// A matrix with three unknowns per node. Fixed unknowns have a row and a column of zeros, and one on the diagonal.
using NodeMatrix = BlockRows<double, 3, 3>;

}  // namespace driftwright::solver
