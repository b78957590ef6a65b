#pragma once
// A measured record as the diagnosis wants it: what drove the machine, and readings beside the model's outputs.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/mapped_record.hpp"
#include "scenarios/reader/recorded_run.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::diagnosis {

/// One reading that is compared with the model.
struct MeasuredChannel {
  std::string name;
  int output = -1;                 ///< of the model
  std::string unit;                ///< "K", "m" or "rad"
  Eigen::VectorXd value;           ///< per time; temperatures minus the reference; NaN where missing
  double quantum = 0.0;            ///< step that all readings are multiples of; 0: none found
  std::string recorded_unit = {};  ///< of the record's header
};

using scenarios::DataFinding;

/// A stretch of a record in which nobody saw what drove the machine: the drive before it is held in the run's cyclogram, and nothing that was read within counts.
struct Hole {
  double begin_s = 0.0, end_s = 0.0;
};

struct MeasuredRun {
  std::string name;  ///< of the file, without folder and ending
  std::string path;
  std::vector<double> time_s;  ///< from 0
  /// Times at which the model is asked: the rows, and more of them after changes of the drive, where readings with lags bend.
  std::vector<double> grid_s;
  std::vector<Eigen::Index> row_in_grid;
  Cyclogram cyclogram;       ///< recorded
  TimeSeries ambient;        ///< recorded, smoothed to knots; minus the reference [K]
  bool has_ambient = false;  ///< else the ambient is the scenario's
  double ambient_noise_K = 0.0,
         ambient_quantum_K = 0.0;  ///< of the recorded one: 1 sigma of white noise, step that it reads in
  std::vector<Hole> holes;         ///< in order of time
  /// Of a run that begins warm (warm_start.hpp), else empty: how much warmer than the scenario's start each part of the machine is, and
  /// directions of what that is not known to.
  Eigen::VectorXd start_K;
  Eigen::MatrixXd start_doubt_K;
  std::vector<MeasuredChannel> channels;
  /// Columns of the record that are neither compared nor a drive, and why.
  struct LeftOut {
    std::string name, why;
  };
  std::vector<LeftOut> left_out;
  std::vector<DataFinding> findings;

  [[nodiscard]] const MeasuredChannel* find(const std::string& channel) const;
};

/// Sets grid_s and row_in_grid of a run whose rows and cyclogram are known.
void set_grid(MeasuredRun& run);

/// Finds the channels of a record, whose source is its file or its name, among the model's outputs. Readings of sensors that the model says read the ambient itself are left
/// out where the record has an ambient temperature.
/// Readings of a sensor that stood still are taken out (stuck_sensor.hpp).
/// @throws InputError  for a record without speed, with fewer than three rows, with a channel that is called as an output but has a
///                     unit of another kind, with an ambient temperature in another unit than its header says, or with nothing to compare
[[nodiscard]] MeasuredRun measured_run(const ReadRecord& read, const scenarios::MachineModel& model,
                                       const solver::Outputs& outputs);
/// The same of a file. @param columns  how it is written, where it is no record CSV
[[nodiscard]] MeasuredRun read_measured(const std::string& path, const scenarios::MachineModel& model,
                                        const solver::Outputs& outputs,
                                        const std::optional<ColumnMap>& columns = std::nullopt);

}  // namespace driftwright::diagnosis
