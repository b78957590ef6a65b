#pragma once
// The result of reducing a machine: a small system that runs any cyclogram in about a millisecond, and the fields of its
// unknowns.

#include "base/listener.hpp"
#include "compensation/predictors/modal_predictor.hpp"
#include "machine/machine.hpp"
#include "solver/krylov_reduction.hpp"

namespace driftwright::scenarios {

/// The requirements that a reduced model is made for.
struct ReductionPlan {
  solver::ReductionDemand demand;
  double tolerance_K = 8e-3;  ///< allowed error of temperatures
  Drive typical;              ///< mean drive, at which the modal predictors freeze laws of temperature
  int n_modes = 20;           ///< of the modal predictors; 0: no such predictors
  bool with_fields = true;    ///< displacements of all nodes may be requested
  bool with_parts = false;    ///< the material of a region may be changed later
  std::vector<bool> moves = {};  ///< of each axis: the model must hold over its travel; empty: at the model's pose alone
};
[[nodiscard]] ReductionPlan reduction_plan(const Scenario& scenario, const std::vector<const Cyclogram*>& cyclograms);

struct Travel;

/// The reduced machine.
struct ReducedMachine {
  mesh::Mesh mesh;
  int n_unknowns = 0;  ///< of the full model
  solver::ReducedSystem system;
  Eigen::VectorXd start;         ///< reduced state at t = 0
  solver::ReductionError error;  ///< estimated error against the full model
  /// None if a thermostat prevents a linear model, or the plan requests none.
  std::optional<compensation::ModalPredictors> modal;
  Eigen::MatrixXf temperature;     ///< of the nodes [K], n_nodes x size
  Eigen::MatrixXf displacement_m;  ///< 3 n_nodes x size; empty without fields
  /// What it is at other poses (travel.hpp); null: it holds at the model's pose alone.
  std::shared_ptr<const Travel> travel = nullptr;

  /// True with fields, and over a travel.
  [[nodiscard]] bool gives_node_temperatures() const { return travel || temperature.size() > 0; }
  /// Temperatures of the nodes above the reference [K], and their displacements, 3 x n_nodes [m], for a reduced state.
  [[nodiscard]] Eigen::VectorXd node_temperature_K(const Eigen::VectorXd& state) const;
  [[nodiscard]] Eigen::Matrix3Xd node_displacement_m(const Eigen::VectorXd& state) const;
};

/// Reduces a machine. Conductivities and heat capacities that depend on temperature are frozen at each region's mean
/// temperature in the steady state of half the demanded power.
/// @throws InputError  for a temperature prescribed over time, which a reduced model cannot represent
/// @throws SolveError  as solver::reduce()
/// With `moves` it has a Travel, and its error is that over the travel. @throws InputError, SolveError  as travel_of()
[[nodiscard]] ReducedMachine reduce(const MachineModel& model, const Machine& machine, const ReductionPlan& plan,
                                    const Listener& listener = {});

}  // namespace driftwright::scenarios
