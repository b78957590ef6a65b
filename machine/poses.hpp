#pragma once
// A machine at a pose: its bodies moved along their axes, and the joints on which they slide found again there.

#include "mesh/mesh.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {

/// Moves the bodies of a mesh from where it was drawn to the model's pose. The sides of joints on which bodies slide or turn
/// are continued along the way (mesh/joint_sides.hpp), so that the joint couples where its sides face each other at any
/// pose.
/// Numbers of nodes and cells stay. Without `axes` nothing is done.
/// @throws InputError  at the axis: for a region that does not exist, that moves without another that shares nodes with it,
///                     or that turns and expands differently along x, y and z; with a film from a file; for a pose at which
///                     bodies overlap, or a joint has lost its guide: its sides face each other nowhere, or the axis moves
///                     them apart
void move_bodies(const MachineModel& model, mesh::Mesh& mesh);

/// A joint on which an axis slides or turns, by their numbers.
struct SlidingJoint {
  std::size_t joint = 0, axis = 0;
};
/// @throws InputError  if an axis moves only a part of a side
[[nodiscard]] std::vector<SlidingJoint> sliding_joints(const std::vector<MovingAxis>& axes, const mesh::Mesh& mesh);

/// Moves the bodies of a mesh that move_bodies() has moved to the pose `from` on to the model's pose.
/// @throws InputError  for a pose at which bodies overlap, or a joint has lost its guide
void move_on(const MachineModel& model, const Pose& from, const std::vector<SlidingJoint>& sliding, mesh::Mesh& mesh);
/// How each region has moved from the pose `from` to the model's pose.
[[nodiscard]] std::vector<mesh::Motion> motions_from(const MachineModel& model, const Pose& from, const mesh::Mesh& mesh);

/// The mechanics of a joint at the model's pose: the axis of a ring turns with its bodies.
/// @throws InputError  if an axis of `axes` that turns carries one side of a ring and changes the direction of the ring's
/// axis
[[nodiscard]] solver::JointMechanics mechanics_at_pose(const MachineModel& model, const mesh::Mesh& mesh,
                                                       const JointEntry& entry);

/// The same model at another pose.
[[nodiscard]] MachineModel at_pose(MachineModel model, const Pose& pose);

}  // namespace driftwright::scenarios
