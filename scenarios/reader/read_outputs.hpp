#pragma once
// The measurements on the machine: thermometers, displacements, tilts.

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/config_map.hpp"
#include "effects/heat_balance.hpp"

namespace driftwright::scenarios {

/// A point on or in a region of the machine.
struct PointOnRegion {
  std::string region;
  Eigen::Vector3d at_m;
  Where where;
};

/// A thermometer: at a point of a region, or on a lumped node ("ambient" is the ambient).
struct Sensor {
  std::string name;
  std::variant<PointOnRegion, std::string> place;
  Where where;
};

/// Tool and table, in the position of the mesh.
struct ToolAgainstTable {
  int axis = 0;  ///< 0, 1, 2 = x, y, z
  PointOnRegion tool;
  std::optional<PointOnRegion> table;  ///< none: the tool against the ground, which is fixed
  /// Travel of the table from its position in the mesh; the indicator then stands on another point of it.
  Eigen::Vector3d travel_m = Eigen::Vector3d::Zero();
};

/// Displacement from mean temperatures: Σ sensitivity (T - T_reference). For machines of lumped nodes, and in addition to
/// a mesh for bodies that are not in it: the screw of a semi-closed axis, whose growth moves the tool unseen by the
/// motor's encoder.
struct BySensitivity {
  struct Term {
    effects::Body body;
    double sensitivity_m_K;
  };
  std::vector<Term> terms;
  Where where;
};

/// A place of a feed axis whose error is read (effects/feed_axis.hpp).
struct OnScrew {
  std::string screw;           ///< name that an effect `feed_axis` gives
  std::optional<double> at_m;  ///< position of the axis; none: where the nut is
  Where where;                 ///< of `screw`, or of `at`
  std::string entry = {};      ///< name of the entry in the scenario, which its places share
  std::size_t n_own = 0;       ///< the first terms of by_sensitivity are the entry's own, the rest are the screw's
};

/// Error of the tool against the table along an axis: actual - commanded. The indicator's stand is a rigid body that
/// moves and turns with the table at its foot; without a table it is fixed to the ground. At least one of the two parts
/// is required; with both the error is their sum, and a positive sensitivity moves the tool along the axis.
struct DisplacementOutput {
  std::string name;
  std::optional<ToolAgainstTable> points = {};
  std::optional<BySensitivity> by_sensitivity = {};
  std::optional<OnScrew> on_screw = {};  ///< its terms are in by_sensitivity once the machine has been read
};

/// Change of the angle of the line from -> to about an axis, against the table (ISO 230-3); right-handed.
struct TiltOutput {
  std::string name;
  int axis = 0;
  PointOnRegion from, to, table;
};

/// The schemas of an entry of `sensors`, `displacements` and `tilts`.
[[nodiscard]] schema::Map sensor_schema();
[[nodiscard]] schema::Map displacement_schema();
[[nodiscard]] schema::Map tilt_schema();
/// The schema of a point on or in a region.
[[nodiscard]] schema::Value point_schema();

[[nodiscard]] PointOnRegion read_point(const ConfigMap& in);
[[nodiscard]] Sensor read_sensor(const ConfigMap& in);
/// One output; or with `positions` one per position of the table, named <name>_<axis><position in mm>; or with `at` one per
/// place of the screw, named <name>_<position in mm>.
[[nodiscard]] std::vector<DisplacementOutput> read_displacements(const ConfigMap& in);
[[nodiscard]] TiltOutput read_tilt(const ConfigMap& in);

}  // namespace driftwright::scenarios
