#pragma once
// The key `axes` of a scenario: bodies of the mesh that slide along named axes or turn about them, the pose of the machine,
// and how cyclograms move it (docs/how-to/poses.md).

#include <string>
#include <vector>

#include "base/config_map.hpp"
#include "base/cyclogram.hpp"
#include "mesh/motion.hpp"

namespace driftwright::scenarios {

/// An axis, and where the machine has it. Positions are in m, of an axis that turns in rad (SI).
struct MovingAxis {
  std::string name;
  std::vector<std::string> moves;      ///< regions that move as one rigid unit
  mesh::Way way;                       ///< as drawn: on which they move while the position rises
  double low_SI = 0.0, high_SI = 0.0;  ///< allowed positions
  bool is_endless = false;             ///< it turns without limits: positions a full turn apart are the same one
  double drawn_at_SI = 0.0;            ///< position of the axis in the mesh as it was drawn
  double at_SI = 0.0;                  ///< position of the axis in this machine
  std::string column;                  ///< recorded column in mm (deg) that moves it
  double step_SI = 0.0;  ///< positions of columns are rounded to a multiple from low_SI (endless: 0) on; 0: not
  Where where;

  /// "mm" or "deg": of columns, and as people write positions.
  [[nodiscard]] const char* unit() const { return way.turns ? "deg" : "mm"; }
  [[nodiscard]] double unit_SI() const;
  /// True within the range, to rounding.
  [[nodiscard]] bool allows(double position_SI) const;
  /// How far two positions are apart, >= 0; full turns of an endless axis do not count.
  [[nodiscard]] double apart_SI(double a_SI, double b_SI) const;
  /// "200 mm", "30 deg"
  [[nodiscard]] std::string words(double position_SI) const;
};

/// The position of each axis [m or rad], in their order.
using Pose = std::vector<double>;

/// The schema of the key `axes`.
[[nodiscard]] schema::Map axes_schema();
/// @throws InputError  file, line and key; also for two axes of one column, a position outside the range, and an axis that
///                     turns a body of an axis above it without carrying all of that axis' bodies, or the reverse
[[nodiscard]] std::vector<MovingAxis> read_axes(const ConfigMap& in);

/// How a region has moved from where it was drawn. An axis carries those below it in the list.
[[nodiscard]] mesh::Motion motion_of(const std::vector<MovingAxis>& axes, const std::string& region);
/// The way of an axis at the pose: the axes that carry it have moved it.
[[nodiscard]] mesh::Way way_at_pose(const std::vector<MovingAxis>& axes, std::size_t axis);

[[nodiscard]] Pose pose_of(const std::vector<MovingAxis>& axes);
/// The same axes at another pose.
[[nodiscard]] std::vector<MovingAxis> axes_at(std::vector<MovingAxis> axes, const Pose& pose);
/// "x = 200 mm, z = -50 mm"
[[nodiscard]] std::string pose_words(const std::vector<MovingAxis>& axes, const Pose& pose);
/// Moves an axis as the user writes it: "x=200mm", "c=30deg". @throws InputError  for an unknown axis, a position that is
/// no length (angle) or is outside the range, and a cyclogram whose column moves this axis
void set_pose(std::vector<MovingAxis>& axes, const std::string& text, const std::vector<Cyclogram>& cyclograms);

/// A time in which no axis moves.
struct PoseStretch {
  double start_s = 0.0, end_s = 0.0;
  Pose pose;
};
/// The poses of a cyclogram in their order; axes without column stay where they are. Neighbours have different poses, and
/// the last stretch ends with the cyclogram. @throws InputError  for a column that is not in mm (deg)
[[nodiscard]] std::vector<PoseStretch> pose_stretches(const std::vector<MovingAxis>& axes, const Cyclogram& cyclogram);
/// True if the cyclogram has a pose other than that of the axes.
[[nodiscard]] bool moves_axes(const std::vector<MovingAxis>& axes, const Cyclogram& cyclogram);

/// @throws InputError  at the axis, for a row of the cyclogram outside its range; position ± stroke / 2 where there is a
///                     column of the stroke
void require_within_range(const std::vector<MovingAxis>& axes, const Cyclogram& cyclogram);
/// For everything that holds the machine at one pose. @throws InputError  at the axis, if the cyclogram moves it
void require_resting(const std::vector<MovingAxis>& axes, const Cyclogram& cyclogram);

}  // namespace driftwright::scenarios
