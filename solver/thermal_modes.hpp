#pragma once
// Thermal modes and steady responses of the full model, which explain a machine's slow memory.

#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// The slowest thermal modes of K(u) φ = λ M φ at fixed inputs: M-orthonormal shapes and time constants τ = 1/λ.
struct ThermalModes {
  Eigen::MatrixXd shapes;               ///< n x n_modes
  std::vector<double> time_constant_s;  ///< in decreasing order
};

/// @param at  inputs at which the films are frozen
/// @throws std::logic_error  for a system that is not linear (linearised() makes one)
/// @throws SolveError  when the eigenvalue iteration does not converge or K(u) is singular (heat cannot leave)
[[nodiscard]] ThermalModes thermal_modes(const FullSystem& system, const effects::Inputs& at, int n_modes);

/// Steady temperatures K(u)⁻¹ b for each source's unit heat and for an ambient one kelvin warmer; n x (n_sources + 1),
/// and one more column for prescribed temperatures and stratified air, if there are any.
/// In a basis they represent what the omitted modes would contribute.
/// @throws SolveError  when K(u) is singular
[[nodiscard]] Eigen::MatrixXd steady_responses(const FullSystem& system, const effects::Inputs& at);

}  // namespace driftwright::solver
