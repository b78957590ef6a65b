#pragma once
// A basis in which the small system answers like the full one, to a tolerance: a block rational Krylov space.
//
// Columns are responses (s M + K(c))⁻¹ b of the full system to its inputs b (each source, the ambient, stratified air, the start) at
// shifts s [1/s] from standing still to seconds and at several sets of coefficients c. K is affine in c, so that films, joints
// and links keep their laws in the small system. Each round adds the responses where the residual is largest; the outputs under
// steps of all inputs then tell how much the round has changed.
// A system of up to a hundred unknowns, a network of lumped nodes, has nothing to leave out: its basis is whole. In a larger one, two like bodies that all sets
// of coefficients join alike are one to the basis, and stay one where a law parts them.
// Source: Grimme, Krylov Projection Methods for Model Reduction (1997); the greedy choice of shifts by the residual follows
// Druskin & Simoncini, Systems & Control Letters 60 (2011) 546-560.

#include "solver/reduction_demand.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::solver {

struct ReductionOptions {
  double temperature_K = 8e-3;    ///< error allowed at outputs in K
  double displacement_m = 16e-9;  ///< and at those in m, with all inputs stepping at once
  double angle_rad = 16e-8;
  int most_rounds = 20;
};

/// The error of a reduced model against the full one, estimated: how much the outputs change under steps of all inputs at
/// once and stepping back, each of its largest magnitude, at every set of coefficients, when the last round is left out;
/// and how much when the basis was compressed.
struct ReductionError {
  double temperature_K = 0.0, displacement_m = 0.0, angle_rad = 0.0;
};

struct Reduction {
  Eigen::MatrixXd basis;  ///< n x size, M-orthonormal; holds the start and the uniform temperature
  ReductionError error;
  int n_rounds = 0, n_solves = 0;
  std::vector<double> shifts_1_s;  ///< in the order they were chosen
};

/// @param start   θ at t = 0; it is in the basis
/// @param system  with exchanges in the order of the demand's coefficients; without nonlinear terms, varying capacity and prescribed unknowns (reducible())
/// @throws SolveError  when K has no inverse (some part has no way for heat to leave), or the tolerance is not met
[[nodiscard]] Reduction reduce(const FullSystem& system, const ReductionDemand& demand, const Eigen::VectorXd& start,
                               const ReductionOptions& options = {});

}  // namespace driftwright::solver
