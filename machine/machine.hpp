#pragma once
// From scenario to computable machine: mesh, matrices, influence vectors; and its runs as records.

#include <memory>

#include "base/record.hpp"
#include "mesh/mesh.hpp"
#include "scenarios/reader/scenario.hpp"
#include "solver/elasticity.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::scenarios {

/// Everything that has been looked up in the mesh: no name is left to be wrong.
struct PlacedMachine {
  mesh::Mesh mesh;
  solver::RegionMaterials materials;
  effects::HeatBalance balance;
  std::vector<solver::Support> supports;
  std::vector<solver::JointMechanics> joints;
  /// Weights of each thermometer on the unknowns; empty for one that reads the ambient.
  std::vector<std::vector<std::pair<int, double>>> sensor_weights;
  /// Displacements, then tilts; of no terms for a displacement by sensitivities alone.
  std::vector<solver::DisplacementFunctional> functionals;
};

/// Meshes the machine and finds every region, surface, joint, node and point of the scenario in it.
/// @throws InputError  for a name or point that does not exist, a region without material, a joint without contact
/// @throws SolveError  when the mesh cannot be made
[[nodiscard]] PlacedMachine place(const MachineModel& model);
/// The same in a mesh that build_mesh() has made of model.mesh.
[[nodiscard]] PlacedMachine place(const MachineModel& model, mesh::Mesh mesh);

/// Materials by region of the mesh, with the factors of effects. @throws InputError  for a region without material, or a material without region
[[nodiscard]] solver::RegionMaterials region_materials(const MachineModel& model, const mesh::Mesh& mesh);

/// The full model, ready to run.
struct Machine {
  PlacedMachine placed;
  /// None without a mesh, where nothing needs it, or when built with known influences.
  std::optional<solver::Elasticity> elasticity;
  solver::FullSystem system;  ///< outputs: sensors [K], displacements [m], tilts [rad], in the scenario's order
};
/// @param with_elasticity  as needs_elasticity() says, or true
/// @param n_fields         about how many displacement fields will be solved for
[[nodiscard]] Machine build(const MachineModel& model, PlacedMachine placed, bool with_elasticity = true, int n_fields = 10);
/// True where displacements or tilts of a mesh are asked for, or whole fields of it.
[[nodiscard]] bool needs_elasticity(const PlacedMachine& placed, bool with_fields);

/// Influence vectors of displacements and tilts, n_nodes x n_functionals; columns of displacements by sensitivities alone are zero.
/// They follow from mesh, materials, supports, joints and points alone, so models that differ in effects share them.
[[nodiscard]] Eigen::MatrixXd influences(const MachineModel& model, const PlacedMachine& placed);
/// build() with influences() that are known: no factorisation, and no displacement fields.
[[nodiscard]] Machine build_with_influences(const MachineModel& model, PlacedMachine placed,
                                            const Eigen::MatrixXd& influence);

/// Bodies whose mean temperature effects on readings look at, each once; the ambient is none of them.
[[nodiscard]] std::vector<effects::Body> bodies_of_readings(const MachineModel& model);

/// What the instruments of a scenario tell, in its order, then mean temperatures of bodies_of_readings() (effects::mean_output()), and who of them reads the ambient; `state` stays empty: before there is a system.
[[nodiscard]] solver::Outputs output_names(const MachineModel& model, const PlacedMachine& placed);

/// Temperatures minus the reference temperature at t = 0, by the scenario's `start`.
/// @throws SolveError  when there is no steady state to start from
[[nodiscard]] Eigen::VectorXd start_state(const MachineModel& model, const Machine& machine);

/// A trajectory as a record: speed_rpm, feeds in mm/min and cutting power in W where the cyclogram uses them, sensors in degC, displacements in um, tilts in urad;
/// no mean temperatures of bodies.
[[nodiscard]] Record to_record(const solver::Trajectory& run, const solver::Outputs& outputs, const Cyclogram& cyclogram,
                               double reference_K);

/// 0, interval, 2 interval, ..., further times within the cyclogram, and its end [s].
[[nodiscard]] std::vector<double> output_times_s(const Cyclogram& cyclogram, double interval_s,
                                                 const std::vector<double>& further_s = {});

}  // namespace driftwright::scenarios
