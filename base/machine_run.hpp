#pragma once
// A run of the machine: what drove it, what surrounded it, what was read, and what is wrong with these data.

#include <string>
#include <vector>

#include "base/cyclogram.hpp"
#include "base/record.hpp"

namespace driftwright {

/// A fault in the data themselves.
struct DataFinding {
  std::string channel;
  std::string what;         ///< a sentence
  bool leaves_out = false;  ///< the channel is not used
};

/// The rows of a record's file that a run uses, given by the times of the first and the last, both since the first row of
/// the file.
struct RowsOfFile {
  std::string file = {};  ///< absolute path; "": not from a file
  double first_s = 0.0, last_s = 0.0;
};

/// Number of earlier rows that a follower may still read.
inline constexpr std::size_t kRowsBack = 32;

/// A run over time, measured or simulated; code that takes one does not know which. Drive and ambient are in SI units, the
/// readings in the units of their channels (Record). The time of all three counts from the first row.
///
/// Who makes it, and what it then contains:
/// - scenarios::run_of(), from a record: drive and ambient as recorded, readings, findings
/// - scenarios::felt_run(), from a recorded drive: drive and ambient that the machine really has, and what drove it before;
///   no readings yet
/// - studies::read_records(), from files: drive and ambient of felt_run(), readings, lead-in, rows, history
/// - simulations and follow::LiveRows: drive, ambient, readings
///
/// Rows [n_before, n_samples) are the run. The rows before are its lead-in, which begins at the last time at which the
/// machine was in balance. Predictors follow the lead-in, so that everything with a memory (lags, states of a model, a
/// fail-safe) has its history at the start of the run. The drift of the lead-in is neither fitted nor scored. Where
/// temperatures and drift count from the start, they count from the first row of the lead-in.
struct MachineRun {
  Cyclogram cyclogram;   ///< the drive; its name is that of the run. No section: unknown
  TimeSeries ambient;    ///< minus the reference temperature [K]; no knot: unknown
  Record readings = {};  ///< channels named like the model's outputs; temperatures in degC, displacements in um

  Cyclogram before = {};                   ///< of felt_run(): the drive between its start and t = 0; usually no section
  std::string ambient_channel = {};        ///< of run_of(): the channel that the ambient was read from; "": from none
  std::vector<DataFinding> findings = {};  ///< of run_of()

  std::size_t n_before = 0;  ///< rows of lead-in, fewer than all
  RowsOfFile rows = {};      ///< rows of the run itself, if it was measured
  std::string history = {};  ///< runs with equal text come from one record and begin at the same row of it; "": none
  /// For a run that goes on while it is followed: number of rows at the front that are no longer stored, and the begin of
  /// the cyclogram's first section. At least kRowsBack rows before the last one are kept.
  std::size_t n_forgotten = 0;
  double cyclogram_from_s = 0.0;

  /// Index of row `row` of the run among the stored readings.
  [[nodiscard]] std::size_t at(std::size_t row) const { return row - n_forgotten; }
  [[nodiscard]] bool has_recorded_ambient() const { return !ambient_channel.empty(); }
};

}  // namespace driftwright
