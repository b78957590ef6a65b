#pragma once
// Temperatures that no longer change, and a system frozen at a state.

#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// Temperatures θ at which no unknown gains heat, at constant drive and ambient. Laws, radiation and properties are taken at the
/// temperatures found (Newton's method without the slope of laws over their probes; the residual is exact). Steps are halved
/// where they would leave the range of a law, or where they do not shrink.
///
/// @param at     drive, ambient and time; prescribed temperatures are those of that time
/// @param start  first guess, and the state that thermostats are set by
/// @throws InputError  when a thermostat would not keep that setting
/// @throws RangeError  when a law is not defined at the first guess
/// @throws SolveError  when some part has no way for heat to leave (names an unknown of it), or after 200 iterations without
///                     convergence to 1e-10 of the largest temperature difference
[[nodiscard]] Eigen::VectorXd steady_state(const FullSystem& system, const effects::Inputs& at,
                                           const Eigen::VectorXd& start);

/// @throws InputError  when the system has thermostats or temperatures prescribed over time, which no linear system can follow
void require_linearisable(const FullSystem& system);

/// Laws that look at temperatures look at those of this state from now on.
void freeze_laws(FullSystem& system, const effects::Inputs& at, const Eigen::VectorXd& theta);

/// Makes of each prescribed temperature an exchange a million times stiffer than the stiffest row of K, with the coefficient 1. They
/// come last, in their order. Temperatures prescribed over time keep their first value: require_linearisable() refuses them.
void hold_by_exchanges(FullSystem& system);

/// The system with every law that looks at temperatures, every nonlinear term and every property frozen at a state: linear,
/// and alike to first order where laws and properties do not change with temperature. Radiation to a lumped node takes the
/// slope between both ends' temperatures for either.
/// @throws InputError  as require_linearisable()
[[nodiscard]] FullSystem linearised(const FullSystem& system, const effects::Inputs& at, const Eigen::VectorXd& theta);

}  // namespace driftwright::solver
