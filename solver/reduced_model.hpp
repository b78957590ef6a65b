#pragma once
// Thermal modes, and the small systems that a basis makes of the full one.

#include "base/cyclogram.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// The slowest thermal modes of K(u) φ = λ M φ at fixed inputs: M-orthonormal shapes and time constants τ = 1/λ.
struct ThermalModes {
  Eigen::MatrixXd shapes;               ///< n x n_modes
  std::vector<double> time_constant_s;  ///< falling
};

/// @param at  inputs at which the films are frozen
/// @throws std::logic_error  for a system that is not linear (linearised() makes one)
/// @throws SolveError  when the eigenvalue iteration does not converge or K(u) is singular (no way for heat to leave)
[[nodiscard]] ThermalModes thermal_modes(const FullSystem& system, const effects::Inputs& at, int n_modes);

/// Steady temperatures K(u)⁻¹ b under each source's unit heat and under a hall one kelvin warmer; n x (n_sources + 1),
/// and one column more for prescribed temperatures and stratified air, where there are any.
/// In a basis they carry what the modes cut off.
/// @throws SolveError  when K(u) is singular
[[nodiscard]] Eigen::MatrixXd steady_responses(const FullSystem& system, const effects::Inputs& at);

/// M-orthonormal basis of the columns; columns that add nothing (below 1e-10 of their length) are dropped.
[[nodiscard]] Eigen::MatrixXd orthonormalise(const SparseRow& mass, const Eigen::MatrixXd& columns);

/// Galerkin projection on an M-orthonormal basis: same laws, small matrices, M = 1. @throws std::logic_error  if not linear
[[nodiscard]] ReducedSystem project(const FullSystem& system, const Eigen::MatrixXd& basis);

/// Runs a cyclogram exactly: in each stretch of constant speed and linear hall temperature the solution is a sum of
/// exponentials, evaluated without time steps. Valid for linear systems.
/// heat_J and stored_J of the result stay empty.
///
/// @param start  reduced state at t = 0
[[nodiscard]] Trajectory evolve(const ReducedSystem& system, const Cyclogram& cyclogram, const TimeSeries& hall,
                                const std::vector<double>& output_s, const Eigen::VectorXd& start);

}  // namespace driftwright::solver
