#pragma once
// A sequence that starts from a known state: the previous run, a pause, and a job that is done once or several times. It is
// one cyclogram, so that the machine's state, the ambient and the times of its effects continue.

#include <cstddef>
#include <optional>
#include <vector>

#include "scenarios/reader/recorded_run.hpp"

namespace driftwright::scenarios {

/// How a job is done.
struct JobOrder {
  std::optional<MachineRun> start;  ///< what the machine did before; none: the job begins in the scenario's start state
  double pause_s = 0.0;             ///< pause at rest between that run and the job, >= 0
  int n_parts = 1;                  ///< how many times the job is done, >= 1
  double between_s = 0.0;           ///< pause at rest between two parts, >= 0
};

/// Rows of one part. If no time passes between two parts, they share a row.
struct PartRows {
  std::size_t first = 0, last = 0;  ///< indices into JobSeries::time_s
};

/// The whole sequence.
struct JobSeries {
  Cyclogram cyclogram;         ///< from the start of the previous run to the end of the last part, named as the job
  TimeSeries ambient;          ///< over the same time, minus the reference temperature [K]
  std::vector<double> time_s;  ///< of outputs: each stretch's own rows and its end, strictly increasing from 0
  std::vector<PartRows> parts;

  /// Start of the first part [s].
  [[nodiscard]] double start_s() const { return time_s[parts.front().first]; }
};

/// During the previous run, its ambient applies. After it, the ambient continues from its last reading and changes by as
/// much as the scenario's ambient changes from that time on:
///
///     ambient(t) = ambient_run(T) + ambient_scenario(t) - ambient_scenario(T)   for t > T, the end of the run
///
/// so that it never jumps. It equals the scenario's ambient if the run was simulated with that. A run without an ambient had
/// the scenario's.
///
/// Recorded columns that the run before and the job both have continue, too. During a pause the axes stay where they are
/// (columns in mm), and all other columns are 0. A pause before the first row has its axes at 0.
/// @param job            at least one section
/// @param scenario_ambient  minus the reference temperature [K]
/// @param interval_s     time between two outputs, > 0
[[nodiscard]] JobSeries job_series(const Cyclogram& job, const JobOrder& order, const TimeSeries& scenario_ambient,
                                   double interval_s);

}  // namespace driftwright::scenarios
