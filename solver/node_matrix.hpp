#pragma once
// The matrix of an elastic body.

#include "solver/block_rows.hpp"

namespace driftwright::solver {

/// A matrix with three unknowns at each node. Those that are fixed have a row and a column of zeros, and one on the diagonal.
using NodeMatrix = BlockRows<double, 3, 3>;

}  // namespace driftwright::solver
