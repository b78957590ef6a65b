#pragma once
// From a scenario to a computable machine: mesh, matrices, influence vectors.

#include <array>
#include <memory>
#include <optional>

#include "base/record.hpp"
#include "machine/mapped_films.hpp"
#include "mesh/mesh.hpp"
#include "scenarios/reader/scenario.hpp"
#include "solver/elasticity.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::solver {
class Ranks;
}

namespace driftwright::scenarios {

/// A machine whose names and points have all been found in the mesh.
struct PlacedMachine {
  mesh::Mesh mesh;
  solver::RegionMaterials materials;
  effects::HeatBalance balance;
  std::vector<MappedFilm> films;  ///< of files
  std::vector<solver::Support> supports;
  std::vector<solver::JointMechanics> joints;
  /// Weights of the unknowns for each thermometer; empty for one that reads the ambient.
  std::vector<std::vector<std::pair<int, double>>> sensor_weights;
  /// Displacements, then tilts; without terms for a displacement that is defined by sensitivities alone.
  std::vector<solver::DisplacementFunctional> functionals;
};

/// Meshes the machine and finds every region, surface, joint, node and point of the scenario in it.
/// @throws InputError  for a name or point that does not exist, a region without material, a joint without contact
/// @throws SolveError  when the mesh cannot be made
[[nodiscard]] PlacedMachine place(const MachineModel& model);
/// The same with a mesh that build_mesh() has made from model.mesh.
[[nodiscard]] PlacedMachine place(const MachineModel& model, mesh::Mesh mesh);

/// The same with the mesh of a machine placed at the model's pose.
[[nodiscard]] PlacedMachine place_again(const MachineModel& model, mesh::Mesh mesh);

/// Materials by region of the mesh, with the factors of effects. @throws InputError for a region without material, or the
/// reverse
[[nodiscard]] solver::RegionMaterials region_materials(const MachineModel& model, const mesh::Mesh& mesh);

/// The error of a tool against the work, as linear functionals of displacements.
struct ToolAgainstWork {
  Eigen::Vector3d place_m;  ///< the tool's end in the frame of the work: where it is when the work is as drawn
  /// u_end - u_foot - ω_foot × arm along x, y, z [m], and ω_tool - ω_foot about x, y, z [rad]. The foot is the point of the
  /// work's region nearest to the ball; what the work carries moves and turns with it as a rigid body.
  std::array<solver::DisplacementFunctional, 6> functionals;
};
/// Two points at the model's pose: one that a rigid body on the tool's point carries, and one that the work carries.
struct ToolAndBall {
  Eigen::Vector3d tool_end_m, ball_m;
};
/// @param mesh  of place(), at the model's pose
/// @param between  the end of the tool and the ball on the work; none: both are at the tool's point
/// @throws InputError  for a region that does not exist, and a tool that is not on its region
[[nodiscard]] ToolAgainstWork tool_against_work(const MachineModel& model, const mesh::Mesh& mesh, const PointOnRegion& tool,
                                                const std::string& work, const Where& where,
                                                const std::optional<ToolAndBall>& between = {});

/// The full model, ready to run.
struct Machine {
  PlacedMachine placed;
  /// None without a mesh, if nothing needs it, or when built with known influences.
  std::optional<solver::Elasticity> elasticity;
  /// Elastic responses K⁻¹l of the displacements and tilts with points, 3 n_nodes each; empty for a machine without
  /// elasticity.
  std::vector<Eigen::VectorXd> responses;
  solver::FullSystem system;  ///< outputs: sensors [K], displacements [m], tilts [rad], in the scenario's order

  /// Temperature unknowns of the whole machine, also where this process has a part of them.
  [[nodiscard]] int n_unknowns() const { return static_cast<int>(system.ones.size()); }
};
/// @param with_elasticity  result of needs_elasticity(), or true
/// @param n_fields         approximate number of displacement fields to be solved for
/// @param ranks            the processes that compute the machine together (`responses` stays empty); null: this one alone
[[nodiscard]] Machine build(const MachineModel& model, PlacedMachine placed, bool with_elasticity = true, int n_fields = 10,
                            const solver::Ranks* ranks = nullptr);
/// True if the outputs contain displacements or tilts of a mesh, or whole fields.
[[nodiscard]] bool needs_elasticity(const PlacedMachine& placed, bool with_fields);

/// Influence vectors of displacements and tilts, n_nodes x n_functionals; columns of displacements by sensitivities alone
/// are zero. They depend on mesh, materials, supports, joints and points only, so models that differ in effects share them.
[[nodiscard]] Eigen::MatrixXd influences(const MachineModel& model, const PlacedMachine& placed);
/// build() with known influences(): no factorisation, and no displacement fields.
[[nodiscard]] Machine build_with_influences(const MachineModel& model, PlacedMachine placed,
                                            const Eigen::MatrixXd& influence,
                                            std::shared_ptr<const solver::Share> share = nullptr);

/// Bodies whose mean temperature is used by effects on readings, each once, without the ambient.
[[nodiscard]] std::vector<effects::Body> bodies_of_readings(const MachineModel& model);

/// The outputs of a scenario: its instruments in its order, then the mean temperatures of bodies_of_readings()
/// (effects::mean_output()), and which of them read the ambient. `state` stays empty, because there is no system yet.
[[nodiscard]] solver::Outputs output_names(const MachineModel& model, const PlacedMachine& placed);

/// Temperatures minus the reference temperature at t = 0, as the scenario's `start` defines them.
/// @throws SolveError  if no steady state exists to start from
[[nodiscard]] Eigen::VectorXd start_state(const MachineModel& model, const Machine& machine);

}  // namespace driftwright::scenarios
