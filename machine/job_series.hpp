#pragma once
// What a machine does from a known state on: the run that was before, a pause, and a job that is done once or several times. All of
// it is one cyclogram, so that the machine's state, the ambient and the times of its effects go on.

#include <cstddef>
#include <optional>
#include <vector>

#include "scenarios/reader/recorded_run.hpp"

namespace driftwright::scenarios {

/// How a job is done.
struct JobOrder {
  std::optional<RecordedRun> start;  ///< what the machine did before; none: the job begins in the scenario's start
  double pause_s = 0.0;              ///< at rest between that run and the job, >= 0
  int n_parts = 1;                   ///< how many times the job is done, >= 1
  double between_s = 0.0;            ///< at rest between two of them, >= 0
};

/// Rows of one part; where no time passes between two parts, they share a row.
struct PartRows {
  std::size_t first = 0, last = 0;  ///< in JobSeries::time_s
};

struct JobSeries {
  Cyclogram cyclogram;         ///< from the start of the run before to the end of the last part, named as the job
  TimeSeries ambient;          ///< over the same time, minus the reference temperature [K]
  std::vector<double> time_s;  ///< of outputs: each stretch's own rows and its end, strictly increasing from 0
  std::vector<PartRows> parts;

  /// When the first part starts [s].
  [[nodiscard]] double start_s() const { return time_s[parts.front().first]; }
};

/// The ambient is that of the run before while it lasts. Behind it the ambient goes on from its last reading by as much as the scenario's
/// ambient changes from that time on:
///
///     ambient(t) = ambient_run(T) + ambient_scenario(t) - ambient_scenario(T)   for t > T, the end of the run
///
/// so that it never jumps, and is the scenario's own where the run was simulated in it. A run without an ambient had the scenario's.
/// @param job            at least one section
/// @param scenario_ambient  minus the reference temperature [K]
/// @param interval_s     between two outputs, > 0
[[nodiscard]] JobSeries job_series(const Cyclogram& job, const JobOrder& order, const TimeSeries& scenario_ambient,
                                   double interval_s);

}  // namespace driftwright::scenarios
