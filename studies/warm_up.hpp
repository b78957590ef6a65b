#pragma once
// How long a machine has to warm up before its next job stays within a tolerance, and by which programme of speeds it is there soonest.
//
// A job's drift counts from its first row: that is where the tool is set. Every programme is run on the model that predicts (prediction.hpp), from
// the state that the machine is in now, with the ambient going on as job_series() says.

#include <string>
#include <vector>

#include "studies/prediction.hpp"

namespace driftwright::studies {

struct WarmUpOptions {
  PredictionOptions from = {};             ///< what was before, the pause behind it, the model; its `parts` and `between` are of the job
  std::vector<std::string> channels = {};  ///< displacements that count; empty: all
  double tolerance_um = 10.0;              ///< > 0
  double kept_free = 0.0;                  ///< share of the tolerance that a programme leaves to what the model does not know, 0 to below 1
  double most_speed_rpm = 0.0;             ///< 0: the fastest of the scenario and the job
  double most_s = 4.0 * 3600.0;            ///< no warm-up is longer
};

/// What a job does behind one way to begin it.
struct WarmUp {
  std::string way = {};                           ///< in words
  std::vector<Cyclogram::Section> sections = {};  ///< before the job; empty: it begins at once
  bool is_enough = false;                       ///< the job then stays within the tolerance
  double peak_um = 0.0;                         ///< of the job's drift from its first row
  std::string peak_channel = {};
  [[nodiscard]] double duration_s() const;
};

/// Least drift that the job can have behind a warm-up of a given time.
struct WarmUpLevel {
  double duration_s = 0.0;
  double constant_um = 0.0, staged_um = 0.0;  ///< behind one speed, behind two
};

struct WarmUpPlan {
  std::vector<std::string> channels;
  double tolerance_um = 0.0, most_speed_rpm = 0.0, most_s = 0.0, kept_free = 0.0;
  WarmUp at_once = {}, at_rest = {}, by_jobs = {}, constant = {}, staged = {};
  std::vector<WarmUpLevel> levels = {};   ///< by time
  Record job_at_once = {}, job_warm = {};  ///< the job's rows at once, and behind the shortest warm-up that is enough or comes nearest
  int n_tried = 0;                  ///< programmes run on the model
  std::string predicted_by = {}, started_from = {};
};

/// Looks for the shortest warm-ups.
///
/// One speed: for speeds up to the limit, the least time is looked for on a grid, between its points where the peak has a least, and then by halves, to
/// 0.5 %. Two speeds, of which either may be rest: the time is halved from the shortest known on, or tried upwards where none is known; at each, programmes (first speed, second speed, share of the first) are tried on a grid and the best improved by a pattern
/// search, until one is within the tolerance. By jobs: the job itself, part after part, until one stays within it.
///
/// @param job  has passed check_cyclogram()
/// @throws InputError  as predict_drift(), for channels that the machine has not, for limits out of range
[[nodiscard]] WarmUpPlan plan_warm_up(const scenarios::Scenario& scenario, const Cyclogram& job, const WarmUpOptions& options,
                                      const Listener& listener);

}  // namespace driftwright::studies
