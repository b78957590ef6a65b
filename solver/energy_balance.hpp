#pragma once
// Checks that a run conserves heat; a run that does not is not shown.

#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// Throws if the heat of a run does not balance. Integrated heat balances up to rounding, or up to the tolerance of the
/// integration if heat capacity depends on temperature. A difference beyond 1 % of the exchanged heat and beyond 0.01 K of
/// the whole machine means that matrices and loads do not match.
///
/// @param capacity_J_K  of the whole system, 1'M 1
/// @throws SolveError   with both sums; NaN counts as out of balance
void require_balance(const Trajectory& run, double capacity_J_K);

}  // namespace driftwright::solver
