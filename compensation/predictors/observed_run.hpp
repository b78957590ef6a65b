#pragma once
// A run of the machine as predictors see it: drive, ambient and readings, and how much of them came before what is fitted and scored.

#include <span>
#include <string>
#include <vector>

#include "base/cyclogram.hpp"
#include "base/record.hpp"

namespace driftwright::compensation {

/// Rows of a record's file, by the times of the first and the last, both since the first row of the file.
struct RowsOfFile {
  std::string file = {};  ///< absolute; "": of no file
  double first_s = 0.0, last_s = 0.0;
};

/// Rows that a follower may look back by.
inline constexpr std::size_t kRowsBack = 32;

/// Rows [n_before, n_samples) are the run; those before it are its lead-in, from the last time on at which the machine was in balance. Predictors
/// follow the lead-in, so that what has a memory - lags, states of a model, a fail-safe - starts the run with what came before it; nothing is fitted
/// to its drift, and it is not scored. Where temperatures and drift count from the start, they count from the first row of the lead-in.
struct ObservedRun {
  Cyclogram cyclogram;       ///< from the first row of the readings, as the ambient
  TimeSeries ambient;        ///< minus the reference temperature [K]
  Record readings;           ///< channels named as the model's outputs; temperatures in degC, displacements in um
  std::size_t n_before = 0;  ///< rows of lead-in, less than all
  RowsOfFile rows = {};      ///< the run's own, where it was measured
  std::string history = {};  ///< runs that share it are of one record and begin at the same row of it; "": of none
  /// Of a run that goes on while it is followed: so many rows in front are no longer kept, and the cyclogram's first section begins at this time.
  /// What stays are kRowsBack rows at least before the last one.
  std::size_t n_forgotten = 0;
  double cyclogram_from_s = 0.0;

  /// Where row `row` of the run stands among the readings.
  [[nodiscard]] std::size_t at(std::size_t row) const { return row - n_forgotten; }
};

/// The readings with temperatures and `target` counted from their first row where `from_start`, and the target missing in the lead-in: what
/// fits and scores may know.
[[nodiscard]] Record scored_readings(const ObservedRun& run, const std::string& target, bool from_start);

/// The rows of the run alone. Its time goes from 0.
[[nodiscard]] Record own_rows(Record readings, std::size_t n_before);

/// Runs of one history as one run, whose target is missing in the rows that none of them has as its own: each reading then counts once. Those
/// of no history stay as they are, and come in their order.
[[nodiscard]] std::vector<ObservedRun> joined_histories(std::span<const ObservedRun> runs, const std::string& target);

}  // namespace driftwright::compensation
