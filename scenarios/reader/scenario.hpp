#pragma once
// A scenario file as plain data in SI units, with nothing computed yet. One read_... function per struct reads it, by the
// schema beside it.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/column_map.hpp"
#include "base/cyclogram.hpp"
#include "base/errors.hpp"
#include "base/fields_format.hpp"
#include "base/machine_limits.hpp"
#include "compensation/sensors/grey_relational.hpp"
#include "effects/effect.hpp"
#include "scenarios/reader/known_together.hpp"
#include "scenarios/reader/programme.hpp"
#include "scenarios/reader/read_axes.hpp"
#include "scenarios/reader/read_axis_loop.hpp"
#include "scenarios/reader/read_mechanics.hpp"
#include "scenarios/reader/read_mesh.hpp"
#include "scenarios/reader/read_outputs.hpp"
#include "scenarios/reader/read_schedule.hpp"
#include "scenarios/reader/read_table.hpp"
#include "scenarios/reader/read_volume.hpp"
#include "scenarios/reader/validation.hpp"
#include "solver/material.hpp"
#include "solver/transient.hpp"

namespace driftwright::scenarios {

/// A region and the material it is made of.
struct MaterialEntry {
  std::string region;
  solver::Material material;
  effects::KnownTo known_to = {};  ///< of conductivity, heat_capacity, expansion
  Where where = {};
};

/// The state at t = 0.
enum class Start {
  kReference,  ///< everything at the reference temperature
  kAmbient,    ///< everything at the first ambient temperature
  kUniform,    ///< everything at MachineModel::start_K
  kSteady,     ///< the steady state at standstill in the first ambient temperature
};

/// All data that the simulation needs.
struct MachineModel {
  double reference_K = 293.15;
  MeshRecipe mesh;
  std::vector<MaterialEntry> materials;
  std::vector<SupportEntry> supports;
  std::vector<JointEntry> joints;  ///< mechanics of joints that are not tied
  std::vector<MovingAxis> axes;    ///< and their positions; bodies of the mesh are moved there by place()
  std::vector<effects::Effect> effects;
  std::vector<Sensor> sensors;
  std::vector<DisplacementOutput> displacements;
  std::vector<TiltOutput> tilts;
  Start start = Start::kReference;
  double start_K = 293.15;  ///< for Start::kUniform
  TimeSeries ambient;       ///< minus reference_K [K]
  KnownTogether known_together;  ///< what a fit left open of the numbers above
  Where where;
  std::string
      written;  ///< the keys that determine mesh and matrices, as in the scenario; numbers of effects are not included
};

/// True if the scenario says with `known_to` or `known_together` how well some number is known. A number that is `fixed`
/// says nothing.
[[nodiscard]] bool says_known_to(const MachineModel& model);

/// The model that a cyclogram is simulated on.
enum class ModelKind {
  kFull,     ///< the finite elements
  kReduced,  ///< a small system reduced from them, which is kept on disk
};

struct SolverSettings {
  ModelKind model = ModelKind::kFull;
  double reduction_tolerance_K =
      8e-3;  ///< estimated error of the reduced model against the full one; with 2 um/K and 20 urad/K
  solver::TransientOptions transient;
  double output_interval_s = 60.0;
  double fields_every_s = 1800.0;
  std::vector<double> fields_at_s;  ///< replaces fields_every_s unless empty; the start and the end are always written
  bool stresses = false;            ///< stresses beside the other fields
  FieldsFormat fields_format = FieldsFormat::kVtu;
};

/// What is fitted, and the data that it is judged by.
struct Study {
  std::string target;                   ///< displacement channel that is ranked and judged
  std::vector<std::string> candidates;  ///< temperature channels to choose from; empty: all of the record
  /// Temperatures and target are zero at the first row of each record, as when the tool is set before each run.
  bool count_from_start = false;
  compensation::Image image = compensation::Image::kAutomatic;  ///< method of ranking the sensors
  std::vector<std::string> train;                               ///< names of cyclograms
  std::string judge;                                            ///< name of a cyclogram
  int sensors_to_choose = 4;
  /// Resolution of the thermometers' readings [K], 0 = exact. Predictors are fitted and judged on readings rounded to it.
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
  std::optional<ColumnMap> columns;     ///< format of the records given to verbs; absent: as in docs/reference/record.md
  std::map<std::string, std::string> topics;  ///< by the channels' headers: where `follow` gets their numbers
  MachineLimits limits;
  std::vector<Cyclogram> cyclograms;
  SolverSettings solver;
  std::optional<Study> study;
  std::optional<Programme> programme;
  std::optional<Validation> validation;
  std::optional<ScheduleSettings> schedule;
  std::optional<AxisLoopSettings> axis_loop;
  std::optional<TableSettings> table;  ///< its points follow the machine's own displacements
  std::optional<VolumeSettings> volume;

  /// @throws InputError  listing the existing cyclograms
  [[nodiscard]] const Cyclogram& cyclogram(const std::string& cyclogram_name) const;
};

/// The schemas of a scenario file: with a machine, or about records alone.
[[nodiscard]] const std::vector<schema::Map>& scenario_schemas();

/// Checks whether a cyclogram can be run on the scenario's machine: that no speed is above `limits`, that every law is
/// defined at every speed, and that there are not too many outputs. read_scenario() checks the scenario's own.
/// @throws InputError
void check_cyclogram(const Scenario& scenario, const Cyclogram& cyclogram);

/// @throws InputError  with file, line and key
[[nodiscard]] Scenario read_scenario(const std::string& path);
/// The same from the top map of a scenario, which may have been edited.
[[nodiscard]] Scenario read_scenario(const ConfigMap& in);

/// Checks a speed that is asked for against `limits`. @param who  what asks for it, such as "--speed-limit"
/// @throws InputError  above it
void require_speed_within_limits(const Scenario& scenario, double speed_rpm, const std::string& who);

/// The scenario's machine, or its study. @param verb  verb that needs it. @throws InputError  if there is none
[[nodiscard]] const MachineModel& require_machine(const Scenario& scenario, const std::string& verb);
[[nodiscard]] const Study& require_study(const Scenario& scenario, const std::string& verb);

}  // namespace driftwright::scenarios
