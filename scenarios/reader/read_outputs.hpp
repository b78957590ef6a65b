#pragma once
// What is measured on the machine: thermometers, displacements, tilts.

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

/// Tool and table as the mesh has them.
struct ToolAgainstTable {
  int axis = 0;  ///< 0, 1, 2 = x, y, z
  PointOnRegion tool;
  std::optional<PointOnRegion> table;  ///< none: the tool against the ground, which neither moves nor turns
  /// How far the table has travelled from where the mesh has it: the indicator then stands on another spot of it.
  Eigen::Vector3d travel_m = Eigen::Vector3d::Zero();
};

/// Displacement by mean temperatures: Σ sensitivity (T - T_reference). For machines of lumped nodes, and beside a mesh for bodies
/// that are not in it: the screw of a semi-closed axis, whose growth moves the tool and is unseen by the motor's encoder.
struct BySensitivity {
  struct Term {
    effects::Body body;
    double sensitivity_m_K;
  };
  std::vector<Term> terms;
  Where where;
};

/// Error of the tool against the table along an axis: actual - commanded. The stand of the indicator is a rigid body that
/// moves and turns with the table at its foot; without a table it stands on the ground. One of both parts at least; with both
/// the error is their sum, and a positive sensitivity moves the tool along the axis.
struct DisplacementOutput {
  std::string name;
  std::optional<ToolAgainstTable> points = {};
  std::optional<BySensitivity> by_sensitivity = {};
};

/// Change of angle of the line from -> to about an axis, against the table (ISO 230-3); right-handed.
struct TiltOutput {
  std::string name;
  int axis = 0;
  PointOnRegion from, to, table;
};

/// What an entry of `sensors`, `displacements` and `tilts` may hold.
[[nodiscard]] schema::Map sensor_schema();
[[nodiscard]] schema::Map displacement_schema();
[[nodiscard]] schema::Map tilt_schema();

[[nodiscard]] Sensor read_sensor(const ConfigMap& in);
/// One output, or with `positions` one per position of the table, named <name>_<axis><position in mm>.
[[nodiscard]] std::vector<DisplacementOutput> read_displacements(const ConfigMap& in);
[[nodiscard]] TiltOutput read_tilt(const ConfigMap& in);

}  // namespace driftwright::scenarios
