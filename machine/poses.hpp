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

/// The mechanics of a joint at the model's pose: the axis of a ring turns with its bodies.
/// @throws InputError  if an axis of `axes` that turns carries one side of a ring and changes the direction of the ring's
/// axis
[[nodiscard]] solver::JointMechanics mechanics_at_pose(const MachineModel& model, const mesh::Mesh& mesh,
                                                       const JointEntry& entry);

/// The same model at another pose.
[[nodiscard]] MachineModel at_pose(MachineModel model, const Pose& pose);

}  // namespace driftwright::scenarios
