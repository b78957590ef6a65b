#pragma once
// The key `axes` of a scenario: bodies of the mesh that slide along named axes, the pose of the machine, and how cyclograms
// move it (docs/how-to/poses.md).

#include <string>
#include <vector>

#include "base/config_map.hpp"
#include "base/cyclogram.hpp"

namespace driftwright::scenarios {

/// An axis, and where the machine has it.
struct MovingAxis {
  std::string name;
  std::vector<std::string> moves;    ///< regions that slide as one rigid unit
  Eigen::Vector3d along;             ///< direction of length 1 in which they slide while the position rises
  double low_m = 0.0, high_m = 0.0;  ///< allowed positions
  double drawn_at_m = 0.0;           ///< position of the axis in the mesh as it was drawn
  double at_m = 0.0;                 ///< position of the axis in this machine
  std::string column;                ///< recorded column in mm that moves it
  double step_m = 0.0;               ///< positions of columns are rounded to low_m + a multiple of this; 0: not rounded
  Where where;
};

/// The position of each axis [m], in their order.
using Pose = std::vector<double>;

/// The schema of the key `axes`.
[[nodiscard]] schema::Map axes_schema();
/// @throws InputError  file, line and key; also for two axes of one column, and a position outside the range
[[nodiscard]] std::vector<MovingAxis> read_axes(const ConfigMap& in);

/// How far a region has moved from where it was drawn [m].
[[nodiscard]] Eigen::Vector3d shift_m(const std::vector<MovingAxis>& axes, const std::string& region);

[[nodiscard]] Pose pose_of(const std::vector<MovingAxis>& axes);
/// "x = 200 mm, z = -50 mm"
[[nodiscard]] std::string pose_words(const std::vector<MovingAxis>& axes, const Pose& pose);
/// Moves an axis as the user writes it: "x=200mm". @throws InputError  for an unknown axis, a position that is no length or
/// is outside the range, and a cyclogram whose column moves this axis
void set_pose(std::vector<MovingAxis>& axes, const std::string& text, const std::vector<Cyclogram>& cyclograms);

/// A time in which no axis moves.
struct PoseStretch {
  double start_s = 0.0, end_s = 0.0;
  Pose pose;
};
/// The poses of a cyclogram in their order; axes without column stay where they are. Neighbours have different poses, and
/// the last stretch ends with the cyclogram. @throws InputError  for a column that is not in mm
[[nodiscard]] std::vector<PoseStretch> pose_stretches(const std::vector<MovingAxis>& axes, const Cyclogram& cyclogram);
/// True if the cyclogram has a pose other than that of the axes.
[[nodiscard]] bool moves_axes(const std::vector<MovingAxis>& axes, const Cyclogram& cyclogram);

/// @throws InputError  at the axis, for a row of the cyclogram outside its range
void require_within_range(const std::vector<MovingAxis>& axes, const Cyclogram& cyclogram);
/// For everything that holds the machine at one pose. @throws InputError  at the axis, if the cyclogram moves it
void require_resting(const std::vector<MovingAxis>& axes, const Cyclogram& cyclogram);

}  // namespace driftwright::scenarios
