#pragma once
// The model of a functional mock-up unit as numbers: the reduced machine, or an observer over it.

#include <optional>
#include <string>
#include <vector>

#include "compensation/control/probe_feedback.h"
#include "compensation/predictors/observer.hpp"
#include "machine/model.hpp"
#include "output/fmu/drive_law.hpp"

namespace driftwright::output {

struct FmuOutput {
  std::string name, unit;             ///< "degC", "um" or "urad"
  Eigen::VectorXd state;              ///< K, m or rad per unit of each state
  double ambient = 0.0;               ///< per kelvin of the ambient, in K, m or rad
  double factor = 1.0, offset = 0.0;  ///< from K, m, rad to the unit
};

/// The law of a source or an exchange that follows temperatures (live_law of sources/model_data.h).
struct FmuLiveLaw {
  std::vector<double> steps = {};  ///< pairs of operation and number; names are indices of the drive, then of the probes
  Eigen::MatrixXd weights = {};    ///< n_states x n_probes
  std::vector<double> ambient_share = {}, offset_K = {};
};
/// A law of several variables of the drive as a formula (drive_formula of sources/model_data.h); empty: none.
using FmuFormula = std::vector<double>;
/// What an output has of a place of an axis (output_along of sources/model_data.h).
struct FmuAlong {
  int output = 0, variable = 0;
  std::vector<double> ends_mm = {};  ///< of the pieces
  std::vector<double> cubics =
      {};  ///< of each piece four rows: of the states and of the ambient, by powers of mm from its begin
};
struct FmuSource {
  Eigen::VectorXd load;
  DriveLaw power_W;  ///< 0 beside a live law or a formula
  std::optional<FmuLiveLaw> live = {};
  FmuFormula formula = {};
  int thermostat = -1;  ///< index; while it is off, so is the source
};
/// A switch with hysteresis; its probe is weights' z + ambient_share ambient + offset_K, absolute.
struct FmuThermostat {
  std::string name;
  double on_above_K = 0.0, off_below_K = 0.0;
  Eigen::VectorXd weights;
  double ambient_share = 0.0, offset_K = 0.0;
};
/// What an output has of the drive at once, in K, m or rad.
struct FmuDirect {
  int output = 0;
  DriveLaw law;
};
struct FmuExchange {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd to_ambient, offset;
  DriveLaw coefficient;  ///< beside a live law: its value at the temperatures of the start; 0 beside a formula
  std::optional<FmuLiveLaw> live = {};
  FmuFormula formula = {};
};

/// What an observer unit has in addition: its sensors, settings and learned factors.
struct FmuObserver {
  std::vector<int> sensor_output = {};  ///< indices of outputs
  std::vector<std::string> sensors = {};
  int drift_output = 0;
  compensation::ObserverSettings settings = {};
  compensation::Observer::Belief factors = {};
  std::optional<probe_process> probing = {};  ///< of what it leaves, for probings; none: it takes none
};

/// dz/dt = -K z + f, M = 1, as solver::ThermalSystem. For a machine, parts that the drive does not change are summed in
/// K0, f0 and h0; an observer has a factor on each source and exchange and keeps them separate.
struct FmuModel {
  std::string name = {};         ///< of the scenario
  std::string description = {};  ///< one sentence
  std::vector<DriveRange> drive = {};
  double reference_K = 293.15;
  Eigen::MatrixXd conduction = {};
  Eigen::VectorXd constant_load = {}, ambient_load = {};
  std::vector<FmuSource> sources = {};
  std::vector<FmuExchange> exchanges = {};
  std::vector<FmuOutput> outputs = {};
  std::vector<FmuAlong> along = {};
  std::vector<FmuThermostat> thermostats = {};
  std::vector<FmuDirect> direct = {};
  /// What the last states begin with, as many as these: what a row gives when the states before them and the ambient are at
  /// their start. Elements of `along_first` name them as outputs.size() + k.
  std::vector<FmuOutput> first = {};
  std::vector<FmuAlong> along_first = {};
  Eigen::VectorXd start = {}, ones = {};
  double start_ambient_K = 0.0;
  bool start_follows_ambient = false;
  TimeSeries ambient = {};
  std::vector<std::vector<double>> known_drives = {};  ///< of the cyclograms; their decompositions are made with an instance
  double duration_s = 0.0;                             ///< of the cyclogram of the reference result
  std::optional<FmuObserver> observer = {};
};

/// Checks whether a scenario's machine can be exported, that is, whether drive and ambient determine it. Fast; call it
/// before anything is computed.
/// @throws InputError  naming the effect: one of drive, ambient or instruments, one limited to a time or a cyclogram, one
/// that follows a column, unless it is the place of a feed axis
void require_exportable(const scenarios::Scenario& scenario);

/// @throws InputError  naming the law: without a formula (effects::Law::steps) one that depends on temperatures, or on two
/// variables of the drive together
[[nodiscard]] FmuModel machine_fmu(const scenarios::Scenario& scenario, const scenarios::ReducedMachine& reduced);
/// The cyclogram with the places of a unit's inputs in its drive.
[[nodiscard]] Cyclogram with_places(Cyclogram cyclogram, const std::vector<DriveRange>& drive);
/// @param probing  what the observer leaves and the probe, of a unit that takes probings
/// @throws InputError  as machine_fmu(), and for thermostats, effects `learned` and each law that depends on temperatures
[[nodiscard]] FmuModel observer_fmu(const scenarios::Scenario& scenario, const compensation::Observer& observer,
                                    const std::optional<probe_process>& probing = {});

}  // namespace driftwright::output
