#pragma once
// Computes a basis in which the small system has the same outputs as the full one, within a tolerance: a block rational
// Krylov space.
//
// Columns are responses (s M + K(c))⁻¹ b of the full system to its inputs b (each source, the ambient, stratified air, the
// start) at shifts s [1/s] from zero (steady state) to 1/seconds and at several sets of coefficients c. K is affine in c, so
// that films, joints and links keep their laws in the small system. Each round adds the responses with the largest residual;
// the change of the outputs under steps of all inputs then measures the effect of the round. A system of up to a hundred
// unknowns, a network of lumped nodes, is not reduced: its basis is complete. In a larger one, two equal bodies with the
// same connections in all sets of coefficients are one body in the basis, and remain one even if a law distinguishes them.
// Source: Grimme, Krylov Projection Methods for Model Reduction (1997); the greedy choice of shifts by the residual follows
// Druskin & Simoncini, Systems & Control Letters 60 (2011) 546-560.

#include "solver/reduction_demand.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::solver {

struct ReductionOptions {
  double temperature_K = 8e-3;    ///< allowed error of outputs in K
  double displacement_m = 16e-9;  ///< allowed error of outputs in m, with steps of all inputs at once
  double angle_rad = 16e-8;
  int most_rounds = 20;
};

/// Estimated error of a reduced model against the full one: the change of the outputs under steps of all inputs at
/// once and back, each with its largest magnitude, for every set of coefficients, when the last round is left out,
/// and when the basis was compressed.
struct ReductionError {
  double temperature_K = 0.0, displacement_m = 0.0, angle_rad = 0.0;
};

/// A basis with its error.
struct Reduction {
  Eigen::MatrixXd basis;  ///< n x size, M-orthonormal; contains the start and the uniform temperature
  ReductionError error;
  int n_rounds = 0, n_solves = 0;
  std::vector<double> shifts_1_s;  ///< in order of choice
};

/// @param start   θ at t = 0; it is included in the basis
/// @param system  with exchanges in the order of the demand's coefficients; without nonlinear terms, varying capacity and
///                prescribed unknowns (reducible())
/// @throws SolveError  when K is singular (heat cannot leave some part), or the tolerance is not reached
[[nodiscard]] Reduction reduce(const FullSystem& system, const ReductionDemand& demand, const Eigen::VectorXd& start,
                               const ReductionOptions& options = {});

}  // namespace driftwright::solver
