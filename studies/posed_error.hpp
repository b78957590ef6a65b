#pragma once
// The error of the tool against the work at one pose, from temperatures of the nodes.

#include <vector>

#include "machine/machine.hpp"

namespace driftwright::studies {

/// The errors at a pose, actual - commanded, one of each time.
struct VolumePoint {
  scenarios::Pose pose;
  Eigen::Vector3d place_m;                ///< of the tool in the frame of the work (machine/machine.hpp)
  std::vector<Eigen::Vector3d> error_m;   ///< along x, y, z of the machine
  std::vector<Eigen::Vector3d> turn_rad;  ///< about x, y, z
};

/// @param drawn    mesh of build_mesh()
/// @param between  as tool_against_work()
/// @throws InputError  as place() and tool_against_work() at this pose; nothing is solved
void require_pose(const scenarios::MachineModel& model, const scenarios::VolumeSettings& settings, const mesh::Mesh& drawn,
                  const scenarios::Pose& pose, const std::optional<scenarios::ToolAndBall>& between = {});

/// The same, and the elastic machine is solved.
/// @param theta_K  temperatures of the nodes above the reference, one column of each time
[[nodiscard]] VolumePoint errors_at(const scenarios::MachineModel& model, const scenarios::VolumeSettings& settings,
                                    const mesh::Mesh& drawn, const scenarios::Pose& pose, const Eigen::MatrixXd& theta_K,
                                    const std::optional<scenarios::ToolAndBall>& between = {});

}  // namespace driftwright::studies
