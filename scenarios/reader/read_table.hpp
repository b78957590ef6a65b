#pragma once
// The key `table` of a scenario: a long table, its scale, its reference rings and its probe (docs/how-to/table.md).

#include <optional>
#include <vector>

#include "base/config_map.hpp"
#include "compensation/frames/probe_study.hpp"
#include "compensation/sensors/thermometers.hpp"
#include "scenarios/reader/read_outputs.hpp"

namespace driftwright::scenarios {

/// A linear scale along an axis, which the control uses as its length reference.
struct TableScale {
  std::vector<std::string> sensors = {};  ///< thermometers on it, or on its carrier; their mean is its temperature
  double expansion_1_K = 0.0;
  double fixed_at_m = 0.0;  ///< position along the axis at which scale and table coordinates agree
};

struct TableRing {
  std::string name = {};
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();
};

/// Measured readings to compare the computed table with.
struct TableReadings {
  std::vector<double> time_s, ambient_K, x_um, y_um, z_um;
};

struct TableSettings {
  std::string region = {};
  Eigen::Vector3d low_m = Eigen::Vector3d::Zero(), high_m = Eigen::Vector3d::Zero();  ///< corners of the judged area
  int n_x = 11, n_y = 3;
  Eigen::Vector3d head_m = Eigen::Vector3d::Zero();  ///< point where the table is held along X and Y: reading head or nut
  TableScale scale_x;
  std::optional<TableScale> scale_y;
  std::vector<TableRing> rings;
  std::string cyclogram = {};
  double every_s = 10800.0;      ///< between two measurements of the rings
  double probe_noise_m = 2e-6;   ///< of a ring's coordinate
  double tolerance_m = 20e-6;    ///< tolerance for which an interval is searched
  double train_from_s = 0.0;     ///< ring measurements of the run from this time on train the temperature strategies
  double judge_until_s = 0.0;    ///< end of the shift
  double model_scatter = 0.1;    ///< scatter of the model between measurements, in each power and coefficient
  std::string thermometer = {};  ///< of the control's own compensation
  double update_s = 300.0;       ///< interval of its setting data, and of readings of every thermometer
  compensation::Thermometers instrument = {.noise_K = 0.1,
                                           .resolution_K = 0.1};  ///< of all thermometers, read every update_s
  double sensor_mean_s = 0.0;                          ///< averaging time of readings, backwards; 0: the last one only
  double velocity_m_s = 0.5;                           ///< MD32000
  double slew = 0.01;                                  ///< MD32760
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< origin of the mesh, in the machine's coordinates
  bool against_dk = false;                             ///< the control moves the axis by -dK
  double ball_diameter_m = 6e-3;                       ///< of the stylus
  int probe_tool = 99;                                 ///< its number in the tool table of LinuxCNC
  int seed = 1;
  compensation::ProbeStudySettings probe;
  std::optional<TableReadings> readings;
  Where where;
};

/// The schema of the key `table`.
[[nodiscard]] schema::Map table_schema();

/// The points of the table that are judged, row by row along X, then the rings, then the head.
[[nodiscard]] std::vector<Eigen::Vector3d> table_points(const TableSettings& table);

/// Displacements of those points against the ground, three per point, named table_<number>_<axis>.
[[nodiscard]] std::vector<DisplacementOutput> table_displacements(const TableSettings& table);

/// @param sensors, cyclograms  of the scenario's machine, by name
/// @throws InputError  file, line and key; also for rings off the table, rings at the same place or with the same name,
/// or in the wrong order
[[nodiscard]] TableSettings read_table(const ConfigMap& in, const std::vector<std::string>& sensors,
                                       const std::vector<std::string>& cyclograms);

}  // namespace driftwright::scenarios
