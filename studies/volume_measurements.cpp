#include "studies/volume_measurements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/dense.hpp"

namespace driftwright::studies {
namespace {

using scenarios::MachineModel, scenarios::MovingAxis, scenarios::Pose, scenarios::ToolAndBall, scenarios::VolumeSettings;

/// From a ball on the work to the tool's point, at the pose of the axes.
Eigen::Vector3d from_ball_m(const std::vector<MovingAxis>& axes, const VolumeSettings& settings,
                            const Eigen::Vector3d& ball_m) {
  return scenarios::motion_of(axes, settings.tool.region)(settings.tool.at_m) -
         scenarios::motion_of(axes, settings.work)(ball_m);
}

/// Moves the linear axes until the tool's point is at the ball, or as near as they can bring it. Positions are linear in the
/// distance, so one step is exact; of axes that do the same, each takes its share.
/// @returns  the distance that is left [m] @throws InputError  if an axis would leave its range
double follow_ball(std::vector<MovingAxis>& axes, const VolumeSettings& settings) {
  const scenarios::RTestSettings& test = *settings.r_test;
  const Eigen::Vector3d apart_m = from_ball_m(axes, settings, test.ball_m);
  std::vector<std::size_t> linear;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (!axes[i].way.turns) linear.push_back(i);
  }
  if (linear.empty()) return apart_m.norm();
  Eigen::MatrixXd per_m(3, static_cast<Eigen::Index>(linear.size()));
  for (std::size_t k = 0; k < linear.size(); ++k) {
    std::vector<MovingAxis> moved = axes;
    moved[linear[k]].at_SI += 1.0;
    per_m.col(static_cast<Eigen::Index>(k)) = from_ball_m(moved, settings, test.ball_m) - apart_m;
  }
  constexpr double kNoWay = 1e-9;  // of an axis that moves tool and ball alike: rounding
  const Eigen::VectorXd by_m = dense::shortest_least_squares(per_m, -apart_m, kNoWay);
  for (std::size_t k = 0; k < linear.size(); ++k) {
    MovingAxis& axis = axes[linear[k]];
    axis.at_SI += by_m[static_cast<Eigen::Index>(k)];
    if (!axis.allows(axis.at_SI))
      throw InputError(test.where,
                       fmt::format("to follow the ball at {} = {}, axis '{}' would go to {}, outside its `range`, {} to {}; "
                                   "move the ball or leave out this angle",
                                   axes[test.axis].name, axes[test.axis].words(axes[test.axis].at_SI), axis.name,
                                   axis.words(axis.at_SI), axis.words(axis.low_SI), axis.words(axis.high_SI)));
  }
  return (apart_m + per_m * by_m).norm();
}

std::optional<ToolAndBall> at_ball(const RTest& test, std::size_t i) {
  return ToolAndBall{.tool_end_m = test.balls_m[i], .ball_m = test.balls_m[i]};
}

std::optional<ToolAndBall> on_circle(const BallBar& bar, double radius_m, std::size_t i) {
  return ToolAndBall{.tool_end_m = bar.balls_m[i] + radius_m * bar.directions[i], .ball_m = bar.balls_m[i]};
}

}  // namespace

RTest commanded_r_test(const std::vector<MovingAxis>& axes, const VolumeSettings& settings) {
  const scenarios::RTestSettings& asked = *settings.r_test;
  RTest test{.direction = scenarios::way_at_pose(axes, asked.axis).direction,
             .poses = {},
             .angles_rad = asked.angles_rad,
             .balls_m = {},
             .arms_m = {},
             .moved_m = {},
             .fits = {}};
  for (const double angle_rad : asked.angles_rad) {
    std::vector<MovingAxis> here = axes;
    here[asked.axis].at_SI = angle_rad;
    test.reach_m = std::max(test.reach_m, follow_ball(here, settings));
    test.poses.push_back(scenarios::pose_of(here));
    test.balls_m.push_back(scenarios::motion_of(here, settings.work)(asked.ball_m));
    test.arms_m.push_back(test.balls_m.back() - scenarios::way_at_pose(here, asked.axis).through_m);
  }
  if (!fit_r_test(test.direction, test.arms_m, test.arms_m))
    throw InputError(asked.where, "the ball must be off the axis, and three of the `angles` must be different positions");
  return test;
}

BallBar commanded_ball_bar(const std::vector<MovingAxis>& axes, const VolumeSettings& settings) {
  const scenarios::BallBarSettings& asked = *settings.ball_bar;
  std::vector<MovingAxis> here = axes;
  for (std::size_t k = 0; k < 2; ++k) here[asked.axes[k]].at_SI = asked.centre_m[k];
  const Eigen::Vector3d centre_m = scenarios::motion_of(here, settings.tool.region)(settings.tool.at_m);
  const Eigen::Vector3d ball_m = scenarios::motion_of(here, settings.work).before(centre_m);  // as drawn
  BallBar bar;
  for (int i = 0; i < asked.n_points; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / asked.n_points;
    here[asked.axes[0]].at_SI = asked.centre_m[0] + asked.radius_m * std::cos(angle_rad);
    here[asked.axes[1]].at_SI = asked.centre_m[1] + asked.radius_m * std::sin(angle_rad);
    const Eigen::Vector3d bar_m = from_ball_m(here, settings, ball_m);
    constexpr double kSame = 1e-9;  // rounding
    if (std::abs(bar_m.norm() - asked.radius_m) > kSame * (1.0 + asked.radius_m))
      throw InputError(asked.where, fmt::format("axes '{}' and '{}' do not move the tool against the work on a circle; both "
                                                "must move either `tool` or `work`, and the other axes must not turn them",
                                                here[asked.axes[0]].name, here[asked.axes[1]].name));
    bar.poses.push_back(scenarios::pose_of(here));
    bar.angles_rad.push_back(angle_rad);
    bar.balls_m.push_back(scenarios::motion_of(here, settings.work)(ball_m));
    bar.directions.push_back(bar_m / bar_m.norm());
  }
  return bar;
}

void require_poses(const RTest& test, const MachineModel& model, const VolumeSettings& settings, const mesh::Mesh& drawn) {
  for (std::size_t i = 0; i < test.poses.size(); ++i) require_pose(model, settings, drawn, test.poses[i], at_ball(test, i));
}

void require_poses(const BallBar& bar, const MachineModel& model, const VolumeSettings& settings, const mesh::Mesh& drawn) {
  for (std::size_t i = 0; i < bar.poses.size(); ++i)
    require_pose(model, settings, drawn, bar.poses[i], on_circle(bar, settings.ball_bar->radius_m, i));
}

void take_readings(RTest& test, const MachineModel& model, const VolumeSettings& settings, const mesh::Mesh& drawn,
                   const Eigen::MatrixXd& theta_K, const Listener& listener) {
  listener.begin(fmt::format("R-test at {} positions", test.poses.size()));
  test.moved_m.assign(static_cast<std::size_t>(theta_K.cols()), {});
  for (std::size_t i = 0; i < test.poses.size(); ++i) {
    listener.share(static_cast<double>(i) / static_cast<double>(test.poses.size()));
    const VolumePoint point = errors_at(model, settings, drawn, test.poses[i], theta_K, at_ball(test, i));
    for (std::size_t t = 0; t < test.moved_m.size(); ++t) test.moved_m[t].push_back(-point.error_m[t]);
  }
  for (const auto& moved_m : test.moved_m) test.fits.push_back(fit_r_test(test.direction, test.arms_m, moved_m).value());
}

void take_readings(BallBar& bar, const MachineModel& model, const VolumeSettings& settings, const mesh::Mesh& drawn,
                   const Eigen::MatrixXd& theta_K, const Listener& listener) {
  listener.begin(fmt::format("ball-bar at {} positions", bar.poses.size()));
  bar.longer_m.assign(static_cast<std::size_t>(theta_K.cols()), {});
  for (std::size_t i = 0; i < bar.poses.size(); ++i) {
    listener.share(static_cast<double>(i) / static_cast<double>(bar.poses.size()));
    const VolumePoint point =
        errors_at(model, settings, drawn, bar.poses[i], theta_K, on_circle(bar, settings.ball_bar->radius_m, i));
    for (std::size_t t = 0; t < bar.longer_m.size(); ++t) bar.longer_m[t].push_back(bar.directions[i].dot(point.error_m[t]));
  }
  for (const auto& longer_m : bar.longer_m) bar.fits.push_back(fit_circle(bar.angles_rad, longer_m));
}

}  // namespace driftwright::studies
