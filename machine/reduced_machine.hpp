#pragma once
// What is left of a machine once finite elements have done their work: a small system that runs any cyclogram in about a
// millisecond, and the fields of its unknowns.

#include "compensation/predictors/modal_predictor.hpp"
#include "machine/machine.hpp"
#include "solver/krylov_reduction.hpp"

namespace driftwright::scenarios {

/// What a reduced model is made for.
struct ReductionPlan {
  solver::ReductionDemand demand;
  double tolerance_K = 8e-3;
  Drive typical;            ///< mean drive, which the modal predictors freeze laws of temperature at
  int n_modes = 20;         ///< of the modal predictors; 0: none of them
  bool with_fields = true;  ///< whether displacements everywhere may be asked for
  bool with_parts = false;  ///< whether another material of a region may be asked for
};
[[nodiscard]] ReductionPlan reduction_plan(const Scenario& scenario, const std::vector<const Cyclogram*>& cyclograms);

struct ReducedMachine {
  mesh::Mesh mesh;
  int n_unknowns = 0;  ///< of the full model
  solver::ReducedSystem system;
  Eigen::VectorXd start;         ///< reduced state at t = 0
  solver::ReductionError error;  ///< against the full model, estimated
  /// None where a thermostat keeps the machine from having a linear model, or the plan wants none.
  std::optional<compensation::ModalPredictors> modal;
  Eigen::MatrixXf temperature;     ///< of the nodes [K], n_nodes x size
  Eigen::MatrixXf displacement_m;  ///< 3 n_nodes x size; empty without fields

  /// Temperatures of the nodes over the reference [K], and their displacements, 3 x n_nodes [m], in a reduced state.
  [[nodiscard]] Eigen::VectorXd node_temperature_K(const Eigen::VectorXd& state) const;
  [[nodiscard]] Eigen::Matrix3Xd node_displacement_m(const Eigen::VectorXd& state) const;
};

/// Reduces a machine. Conductivities and heat capacities over temperature are frozen at each region's mean temperature in the
/// steady state of half the demanded power.
/// @throws InputError  for a temperature prescribed over time, which no reduced model follows
/// @throws SolveError  as solver::reduce()
[[nodiscard]] ReducedMachine reduce(const MachineModel& model, const Machine& machine, const ReductionPlan& plan);

}  // namespace driftwright::scenarios
