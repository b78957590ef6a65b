#pragma once
// A run of the machine as predictors receive it: drive, ambient and readings, and the number of rows before the part that is
// fitted and scored.

#include <span>
#include <string>
#include <vector>

#include "base/cyclogram.hpp"
#include "base/record.hpp"

namespace driftwright::compensation {

/// The rows of a record's file that a run uses, given by the times of the first and the last, both since the first row of
/// the file.
struct RowsOfFile {
  std::string file = {};  ///< absolute path; "": not from a file
  double first_s = 0.0, last_s = 0.0;
};

/// Number of earlier rows that a follower may still read.
inline constexpr std::size_t kRowsBack = 32;

/// Rows [n_before, n_samples) are the run. The rows before are its lead-in, which begins at the last time at which the
/// machine was in balance. Predictors follow the lead-in, so that everything with a memory (lags, states of a model, a
/// fail-safe) has its history at the start of the run. The drift of the lead-in is neither fitted nor scored. Where
/// temperatures and drift count from the start, they count from the first row of the lead-in.
struct ObservedRun {
  Cyclogram cyclogram;       ///< from the first row of the readings, like the ambient
  TimeSeries ambient;        ///< minus the reference temperature [K]
  Record readings;           ///< channels named like the model's outputs; temperatures in degC, displacements in um
  std::size_t n_before = 0;  ///< rows of lead-in, fewer than all
  RowsOfFile rows = {};      ///< rows of the run itself, if it was measured
  std::string history = {};  ///< runs with equal text come from one record and begin at the same row of it; "": none
  /// For a run that goes on while it is followed: number of rows at the front that are no longer stored, and the begin of
  /// the cyclogram's first section. At least kRowsBack rows before the last one are kept.
  std::size_t n_forgotten = 0;
  double cyclogram_from_s = 0.0;

  /// Index of row `row` of the run among the stored readings.
  [[nodiscard]] std::size_t at(std::size_t row) const { return row - n_forgotten; }
};

/// The readings for fits and scores: temperatures and `target` counted from their first row if `from_start`, and the target
/// missing in the lead-in.
[[nodiscard]] Record scored_readings(const ObservedRun& run, const std::string& target, bool from_start);

/// The rows of the run alone. Its time starts at 0.
[[nodiscard]] Record own_rows(Record readings, std::size_t n_before);

/// Merges runs of one history into one run, in which the target is missing in rows that belong to none of them; so each
/// reading counts once. Runs without a history are unchanged; the order is kept.
[[nodiscard]] std::vector<ObservedRun> joined_histories(std::span<const ObservedRun> runs, const std::string& target);

}  // namespace driftwright::compensation
