#pragma once
// A scenario file as plain data: SI inside, nothing computed yet. One read_... function per struct is its schema.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/cyclogram.hpp"
#include "base/errors.hpp"
#include "effects/effect.hpp"
#include "scenarios/read_mechanics.hpp"
#include "scenarios/read_mesh.hpp"
#include "solver/material.hpp"
#include "solver/transient.hpp"

namespace driftwright::scenarios {

/// A point on or in a region of the machine.
struct PointOnRegion {
  std::string region;
  Eigen::Vector3d at_m;
  Where where;
};

/// A thermometer: at a point of a region, or on a lumped node ("hall" is the hall).
struct Sensor {
  std::string name;
  std::variant<PointOnRegion, std::string> place;
  Where where;
};

/// Error of the tool against the table along an axis: actual - commanded. The stand of the indicator is a rigid body that
/// moves and turns with the table at its foot.
struct DisplacementOutput {
  std::string name;
  int axis = 0;  ///< 0, 1, 2 = x, y, z
  PointOnRegion tool, table;
};

/// Change of angle of the line from -> to about an axis, against the table (ISO 230-3); right-handed.
struct TiltOutput {
  std::string name;
  int axis = 0;
  PointOnRegion from, to, table;
};

/// A region and the material it is made of.
struct MaterialEntry {
  std::string region;
  solver::Material material;
  Where where;
};

/// All that the simulation needs.
struct MachineModel {
  double reference_K = 293.15;
  MeshRecipe mesh;
  std::vector<MaterialEntry> materials;
  std::vector<SupportEntry> supports;
  std::vector<JointEntry> joints;  ///< mechanics of joints that are not tied
  std::vector<effects::Effect> effects;
  std::vector<Sensor> sensors;
  std::vector<DisplacementOutput> displacements;
  std::vector<TiltOutput> tilts;
  TimeSeries hall;  ///< minus reference_K [K]
  Where where;
};

struct SolverSettings {
  solver::TransientOptions transient;
  double output_interval_s = 60.0;
  double fields_every_s = 1800.0;
  bool stresses = false;  ///< stresses beside the other fields
};

/// What is fitted and what it is judged by.
struct Study {
  std::string target;                   ///< displacement channel that ranking and verdict are about
  std::vector<std::string> candidates;  ///< temperature channels to choose from; empty: all of the record
  std::vector<std::string> train;       ///< cyclograms
  std::string judge;                    ///< cyclogram
  int sensors_to_choose = 4;
  /// Step of the thermometers' readings [K], 0 = exact. Predictors are fitted and judged on readings rounded to it.
  double sensor_resolution_K = 0.0;
  int thermal_modes = 20;
  double tolerance_um = 10.0;
  double encoder_period_um = 1.0;
  Where where;
};

struct Scenario {
  std::string path;
  std::string name;
  std::optional<MachineModel> machine;  ///< absent in a scenario about measured records alone
  std::vector<Cyclogram> cyclograms;
  SolverSettings solver;
  std::optional<Study> study;

  /// @throws InputError  naming the cyclograms there are
  [[nodiscard]] const Cyclogram& cyclogram(const std::string& cyclogram_name) const;
};

/// Looks whether a cyclogram can be run on the scenario's machine: every law defined at every speed, outputs not too many.
/// read_scenario() has done so for the scenario's own. @throws InputError
void check_cyclogram(const Scenario& scenario, const Cyclogram& cyclogram);

/// @throws InputError  with file, line and key
[[nodiscard]] Scenario read_scenario(const std::string& path);

}  // namespace driftwright::scenarios
