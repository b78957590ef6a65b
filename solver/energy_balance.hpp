#pragma once
// Heat neither comes from nowhere nor goes there: a run in which it does is not shown.

#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// Ends a run whose heat does not balance. Integrated heat balances to rounding, and to the tolerance of the integration where heat capacity follows
/// temperature; what goes beyond 1 % of the heat turned over and beyond 0.01 K of the whole machine means that matrices and loads do not
/// belong together.
///
/// @param capacity_J_K  of the whole system, 1'M 1
/// @throws SolveError   with both sums; NaN counts as out of balance
void require_balance(const Trajectory& run, double capacity_J_K);

}  // namespace driftwright::solver
