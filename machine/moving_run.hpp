#pragma once
// Runs while axes move: one set of matrices for each pose, and the temperatures of all bodies carried from one to the next.

#include "base/machine_run.hpp"
#include "machine/model.hpp"

namespace driftwright::scenarios {

/// The poses of cyclograms in the order in which they come first, without that of the axes.
[[nodiscard]] std::vector<Pose> further_poses(const std::vector<MovingAxis>& axes,
                                              const std::vector<const Cyclogram*>& cyclograms);
/// Of each axis: true if one of the cyclograms moves it.
[[nodiscard]] std::vector<bool> moved_axes(const std::vector<MovingAxis>& axes,
                                           const std::vector<const Cyclogram*>& cyclograms);
/// @throws InputError  if a thermostat would lose its state between poses
void require_no_thermostat(const MachineModel& model, const effects::HeatBalance& balance);

/// After the first of some poses was made. @throws InputError  if the others take more than the memory that is left
void require_room_for(const MachineModel& model, std::size_t n_poses, double each_bytes);

/// The full machine at every pose of the cyclograms, save at the model's own. Nodes are the same at all poses; couplings, elastic
/// responses and (with fields) the elastic machine are made for each.
/// @param drawn  mesh of build_mesh()
/// @throws InputError  as place(); if a thermostat would lose its state between poses; and if the poses take more than the
///                     memory that is left
[[nodiscard]] std::vector<PosedMachine> posed_machines(const MachineModel& model,
                                                       const std::vector<const Cyclogram*>& cyclograms,
                                                       const mesh::Mesh& drawn, const Listener& listener, bool with_fields);

/// The full machine of a pose; nullptr: that of the model itself. @throws InputError  if it was not made for this pose
[[nodiscard]] const PosedMachine* posed_at(const MachineModel& machine, const Model& model, const Pose& pose);

/// The reduced machine of a pose, likewise.
[[nodiscard]] const PosedReduced* reduced_at(const MachineModel& machine, const Model& model, const Pose& pose);

/// Simulates a cyclogram that moves axes: the run of each stretch of one pose goes on from the state of the one before. The
/// time at which an axis moves belongs to the pose after, as the record's row does. Heat is counted from the start.
/// @param recorded  whose columns move the axes @param felt  drive and ambient of felt_run_as_far_as_known()
/// @throws InputError  as posed_at() @throws SolveError  as solver::simulate()
[[nodiscard]] solver::Trajectory simulate_moving(const MachineModel& machine, const solver::TransientOptions& options,
                                                 const Model& model, const Eigen::VectorXd& from, const Cyclogram& recorded,
                                                 const MachineRun& felt, const std::vector<double>& times_s,
                                                 const solver::OutputCallback& at_output);

}  // namespace driftwright::scenarios
