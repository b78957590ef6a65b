#pragma once
// A linear system from a reduced one whose laws follow temperatures, for the temperatures at which it works.

#include <span>
#include <string>
#include <vector>

#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// Drive, ambient and state of a system at one time of a run. All rows of a list weigh the same.
struct OperatingRow {
  effects::Inputs at;     ///< its probes are not used; `run` must outlive the list
  Eigen::VectorXd state;  ///< of the reduced system
};

/// The temperatures at which a law was made linear.
struct LinearisedLaw {
  std::string name;
  double at_K = 0.0;      ///< absolute; of the first body that the law follows, the ambient only if there is no other
  double spread_K = 0.0;  ///< standard deviation about it
};

struct Linearisation {
  ReducedSystem system;  ///< linear, with the same states; a conductance for each power that follows temperature comes last
  std::vector<LinearisedLaw> laws;
};

/// Statistical linearisation of all laws of temperature about the rows of a run. Each law is evaluated at two states, one
/// standard deviation σ above and below the mean of the rows. Their mean and their difference replace it; both go on to
/// depend on the drive:
///
///     power      P(u, T) ≈ P̄(u) - κ(u) (T_b - T̄_b),  P̄ = (P₊ + P₋) / 2,  κ = (P₋ - P₊) / 2σ
///     exchange   c(u, T) ≈ c̄(u) = (c₊ + c₋) / 2
///
/// T_b: mean temperature of the heated body. Rows count by P², so rest does not count. A law that looks at another body
/// gets, at T̄_b ± σ, the temperatures that the regression of that body on T_b gives; so κ is an exchange with a symmetric
/// matrix. For small σ, κ is the tangent -dP/dT. The coefficient of an exchange is the secant: zero difference remains zero
/// heat, and a machine in balance remains so. Rows count by x², x: its mean temperature difference, so c̄ x has least error
/// in heat.
/// Source: Gelb (ed.), Applied Optimal Estimation (1974), ch. 7 (describing functions); the two states are those of
/// Gauss-Hermite quadrature of order 2.
/// @param system  without thermostats; M = 1
/// @param rows    at least one
/// @throws RangeError  for a law that is not defined at one of its two states
/// @throws std::logic_error  for a system with thermostats, and without rows
[[nodiscard]] Linearisation linearise(const ReducedSystem& system, std::span<const OperatingRow> rows);

}  // namespace driftwright::solver
