#pragma once
// A measured record in the form that the diagnosis needs: the drive, and readings for outputs of the model.

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
  double quantum = 0.0;            ///< step of which all readings are multiples; 0: none found
  std::string recorded_unit = {};  ///< from the record's header
};

/// A stretch of a record with an unknown drive: the run's cyclogram holds the drive before it, and readings within it do
/// not count.
struct Hole {
  double begin_s = 0.0, end_s = 0.0;
};

struct MeasuredRun {
  std::string name;  ///< of the file, without folder and extension
  std::string path;
  std::vector<double> time_s;  ///< from 0
  /// Times at which the model is evaluated: the rows, and additional times after changes of the drive, where readings
  /// with lags bend.
  std::vector<double> grid_s;
  std::vector<Eigen::Index> row_in_grid;
  Cyclogram cyclogram;       ///< recorded
  TimeSeries ambient;        ///< recorded, smoothed to knots; minus the reference [K]
  bool has_ambient = false;  ///< false: the ambient is the scenario's
  double ambient_noise_K = 0.0,
         ambient_quantum_K = 0.0;  ///< of the recorded one: standard deviation of white noise, resolution
  std::vector<Hole> holes;         ///< in order of time
  /// For a run that begins warm (warm_start.hpp), otherwise empty: the start of each part of the machine over the
  /// scenario's, and directions of its uncertainty.
  Eigen::VectorXd start_K;
  Eigen::MatrixXd start_doubt_K;
  std::vector<MeasuredChannel> channels;
  /// Columns of the record that are neither compared nor part of the drive, and the reason.
  struct LeftOut {
    std::string name, why;
  };
  std::vector<LeftOut> left_out;
  std::vector<DataFinding> findings;

  [[nodiscard]] const MeasuredChannel* find(const std::string& channel) const;
};

/// Mean time between the rows of a run [s]; and the shortest of several runs.
[[nodiscard]] double row_s(const MeasuredRun& run);
[[nodiscard]] double shortest_row_s(const std::vector<MeasuredRun>& runs);

/// Sets grid_s and row_in_grid of a run whose rows and cyclogram are known. The cyclogram's last drive holds to the last
/// row.
void set_grid(MeasuredRun& run);

/// Assigns the channels of a record, whose source is its file or name, to the model's outputs. Readings of sensors on the
/// ambient are left out if the record has an ambient temperature. Readings of a sensor that was stuck are removed
/// (stuck_sensor.hpp).
/// @throws InputError  for a record without speed or with fewer than three rows; for a channel with the name of an output
/// but a unit of another kind; for an ambient temperature in another unit than its header says; for an axis that
/// is not at the model's pose; and if there is nothing to compare
[[nodiscard]] MeasuredRun measured_run(const ReadRecord& read, const scenarios::MachineModel& model,
                                       const solver::Outputs& outputs);

/// The temperatures, displacements and tilts of a record that the scenario has no output for and no effect asks for, as
/// channels without an output. Neither spikes nor stuck readings are removed. @param run  as measured_run() gives it
[[nodiscard]] std::vector<MeasuredChannel> channels_without_output(const Record& record, const MeasuredRun& run,
                                                                   const scenarios::MachineModel& model,
                                                                   const solver::Outputs& outputs);

}  // namespace driftwright::diagnosis
