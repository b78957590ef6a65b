#pragma once
// Measurements of a moving machine as an instrument makes them, simulated: R-test (ISO 10791-6) and ball-bar (ISO 230-4).

#include "base/listener.hpp"
#include "studies/turn_errors.hpp"

namespace driftwright::studies {

/// The work turns with a ball on it. The linear axes follow the ball with the tool; the sensors at the ball are fixed to the
/// tool as a rigid body, which spans what they cannot reach. Readings are zero in the cold machine at each position.
struct RTest {
  Eigen::Vector3d direction;           ///< of the axis
  std::vector<scenarios::Pose> poses;  ///< of each position of the axis
  std::vector<double> angles_rad;
  std::vector<Eigen::Vector3d> balls_m;  ///< centre of the ball in the machine
  std::vector<Eigen::Vector3d> arms_m;   ///< from the axis' point to the ball
  double reach_m = 0.0;                  ///< longest distance that the rigid body spans from the tool's point to the ball
  std::vector<std::vector<Eigen::Vector3d>> moved_m;  ///< of each time: of the ball against the sensors, along x, y, z
  std::vector<RTestFit> fits;                         ///< of each time
};

/// The tool moves on a circle about a ball on the work; the bar itself has the reference temperature and no error.
struct BallBar {
  std::vector<scenarios::Pose> poses;
  std::vector<double> angles_rad;
  std::vector<Eigen::Vector3d> balls_m;       ///< in the machine
  std::vector<Eigen::Vector3d> directions;    ///< from the ball to the tool, length 1
  std::vector<std::vector<double>> longer_m;  ///< of each time: actual - commanded radius
  std::vector<CircleFit> fits;                ///< of each time
};

/// What is commanded; nothing is read yet.
/// @param axes  at the scenario's pose, where axes are that do not take part
/// @throws InputError  at the measurement: a linear axis would leave its range, or the positions cannot tell its errors
[[nodiscard]] RTest commanded_r_test(const std::vector<scenarios::MovingAxis>& axes,
                                     const scenarios::VolumeSettings& settings);
[[nodiscard]] BallBar commanded_ball_bar(const std::vector<scenarios::MovingAxis>& axes,
                                         const scenarios::VolumeSettings& settings);

/// @throws InputError  as require_pose() at each of its poses
void require_poses(const RTest& test, const scenarios::MachineModel& model, const scenarios::VolumeSettings& settings,
                   const mesh::Mesh& drawn);
void require_poses(const BallBar& bar, const scenarios::MachineModel& model, const scenarios::VolumeSettings& settings,
                   const mesh::Mesh& drawn);

/// Reads the measurement. @param theta_K  as errors_at()
void take_readings(RTest& test, const scenarios::MachineModel& model, const scenarios::VolumeSettings& settings,
                   const mesh::Mesh& drawn, const Eigen::MatrixXd& theta_K, const Listener& listener);
void take_readings(BallBar& bar, const scenarios::MachineModel& model, const scenarios::VolumeSettings& settings,
                   const mesh::Mesh& drawn, const Eigen::MatrixXd& theta_K, const Listener& listener);

}  // namespace driftwright::studies
