#pragma once
// The key `volume` of a scenario: the poses and times at which the error of the tool against the work is computed, and the
// measurements that are simulated there (docs/how-to/poses.md).

#include <array>
#include <optional>

#include "scenarios/reader/read_axes.hpp"
#include "scenarios/reader/read_outputs.hpp"

namespace driftwright::scenarios {

/// R-test (ISO 10791-6): the work turns with a ball on it, and sensors on the tool read the ball.
struct RTestSettings {
  std::size_t axis = 0;            ///< that turns the work
  Eigen::Vector3d ball_m;          ///< centre, as drawn; the work carries it
  std::vector<double> angles_rad;  ///< positions of the axis
  Where where;
};

/// Circular test with a ball-bar (ISO 230-4): a circle of the tool about a ball on the work.
struct BallBarSettings {
  std::array<std::size_t, 2> axes = {0, 0};  ///< linear, perpendicular; the angle counts from the first to the second
  std::array<double, 2> centre_m = {0, 0};   ///< their positions
  double radius_m = 0.0;
  int n_points = 0;  ///< even over the circle
  Where where;
};

struct VolumeSettings {
  std::string cyclogram;
  PointOnRegion tool;                             ///< where the machine was drawn
  std::string work;                               ///< region that carries the work
  std::vector<std::vector<double>> positions_SI;  ///< of each axis, rising; of an axis that is not listed its `at` alone
  std::vector<double> times_s;                    ///< rising, within the cyclogram
  Where where;
  std::optional<RTestSettings> r_test = {};
  std::optional<BallBarSettings> ball_bar = {};

  /// Number of poses: all combinations of the positions.
  [[nodiscard]] std::size_t n_poses() const;
  /// Pose number i; the first axis changes fastest.
  [[nodiscard]] Pose pose(std::size_t i) const;
};

/// The schema of the key `volume`.
[[nodiscard]] schema::Map volume_schema();
/// @param axes, cyclograms  of the scenario
/// @throws InputError  file, line and key; also for an unknown axis or cyclogram, positions or times out of range, and axes
///                     that a measurement cannot use
[[nodiscard]] VolumeSettings read_volume(const ConfigMap& in, const std::vector<MovingAxis>& axes,
                                         const std::vector<Cyclogram>& cyclograms);

}  // namespace driftwright::scenarios
