#pragma once
// Grey radiation from a surface to a surrounding that encloses it, with the local temperature of the surface.

#include <memory>

#include "effects/heat_balance.hpp"
#include "mesh/mesh.hpp"
#include "solver/nonlinear_term.hpp"

namespace driftwright::solver {

/// The term r_i = ∫ emissivity σ (T^4 - T_s^4) N_i dA, σ = 5.670374419e-8 W/(m^2 K^4), integrated by the rule of the mass
/// matrix.
///
/// @param surface              index of the surface
/// @param surrounding_unknown  lumped node that it radiates to, -1 for the ambient
/// @param air                  stratification of the ambient, which also applies to the surrounding
[[nodiscard]] std::shared_ptr<const NonlinearTerm> radiating_surface(const mesh::Mesh& mesh,
                                                                     const effects::Radiation& radiation, int surface,
                                                                     int surrounding_unknown,
                                                                     const std::vector<effects::Stratification>& air,
                                                                     double reference_K);

/// Difference [K] between the ambient air at a height and at the ambient thermometer.
[[nodiscard]] double ambient_offset_K(const std::vector<effects::Stratification>& air, double height_m);

}  // namespace driftwright::solver
