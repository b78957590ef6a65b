#include "studies/posed_error.hpp"

#include "machine/poses.hpp"

namespace driftwright::studies {
namespace {

using scenarios::MachineModel, scenarios::Pose, scenarios::VolumeSettings;

/// The machine at a pose with the six errors as its functionals.
struct PlacedAtPose {
  MachineModel model;
  scenarios::PlacedMachine placed;
  Eigen::Vector3d place_m;  ///< of the tool in the frame of the work
};

PlacedAtPose placed_at(const MachineModel& model, const VolumeSettings& settings, const mesh::Mesh& drawn, const Pose& pose,
                       const std::optional<scenarios::ToolAndBall>& between) {
  MachineModel here = scenarios::at_pose(model, pose);
  here.displacements.clear();  // only the six errors are solved for
  here.tilts.clear();
  scenarios::PlacedMachine placed = scenarios::place(here, drawn);
  const scenarios::ToolAgainstWork error =
      scenarios::tool_against_work(here, placed.mesh, settings.tool, settings.work, settings.where, between);
  placed.functionals.assign(error.functionals.begin(), error.functionals.end());
  return {std::move(here), std::move(placed), error.place_m};
}

}  // namespace

void require_pose(const MachineModel& model, const VolumeSettings& settings, const mesh::Mesh& drawn, const Pose& pose,
                  const std::optional<scenarios::ToolAndBall>& between) {
  (void)placed_at(model, settings, drawn, pose, between);
}

VolumePoint errors_at(const MachineModel& model, const VolumeSettings& settings, const mesh::Mesh& drawn, const Pose& pose,
                      const Eigen::MatrixXd& theta_K, const std::optional<scenarios::ToolAndBall>& between) {
  const PlacedAtPose at = placed_at(model, settings, drawn, pose, between);
  const Eigen::MatrixXd values = scenarios::influences(at.model, at.placed).transpose() * theta_K;  // 6 x n_times
  VolumePoint point{.pose = pose, .place_m = at.place_m, .error_m = {}, .turn_rad = {}};
  for (Eigen::Index t = 0; t < values.cols(); ++t) {
    point.error_m.emplace_back(values.col(t).head<3>());
    point.turn_rad.emplace_back(values.col(t).tail<3>());
  }
  return point;
}

}  // namespace driftwright::studies
