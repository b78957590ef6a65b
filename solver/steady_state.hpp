#pragma once
// Steady-state temperatures, and systems whose laws are frozen at a state.

#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// Temperatures θ at which no unknown gains heat, for constant drive and ambient. Laws, radiation and properties are
/// evaluated at the temperatures found (Newton's method without the slope of laws over their probes; the residual is exact).
/// Steps are halved if they would leave the range of a law, if they grow, or if they turn round without shrinking.
///
/// @param at     drive, ambient and time; prescribed temperatures are those of that time
/// @param start  first guess; it also sets the thermostats
/// @throws InputError  if a thermostat would switch again in the steady state
/// @throws RangeError  when a law is not defined at the first guess
/// @throws SolveError  if heat cannot leave some part (names an unknown of it), or after 200 iterations without
///                     convergence to 1e-10 of the largest temperature difference
[[nodiscard]] Eigen::VectorXd steady_state(const FullSystem& system, const effects::Inputs& at,
                                           const Eigen::VectorXd& start);

/// @throws InputError  when the system has thermostats or temperatures prescribed over time, which no linear system can
///                     follow
void require_linearisable(const FullSystem& system);

/// Laws that depend on temperatures use those of this state from now on.
void freeze_laws(FullSystem& system, const effects::Inputs& at, const Eigen::VectorXd& theta);

/// Replaces each prescribed temperature by an exchange that is a million times stiffer than the stiffest row of K, with the
/// coefficient 1. These come last, in their order. Temperatures prescribed over time keep their first value;
/// require_linearisable() refuses them.
void hold_by_exchanges(FullSystem& system);

/// The system with every law that depends on temperatures, every nonlinear term and every property frozen at a state. It is
/// linear, and equal to first order if laws and properties do not change with temperature. Radiation to a lumped node uses
/// the slope between the temperatures of both ends for either end.
/// @throws InputError  as require_linearisable()
[[nodiscard]] FullSystem linearised(const FullSystem& system, const effects::Inputs& at, const Eigen::VectorXd& theta);

}  // namespace driftwright::solver
