#pragma once
// How long a machine has to warm up before its next job stays within a tolerance, and by which programme of speeds it is there soonest.
//
// A job's drift counts from its first row: that is where the tool is set. Every programme is run on the model that predicts (prediction.hpp), from
// the state that the machine is in now, with the ambient going on as job_series() says.

#include <optional>
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
  double most_power_W = 0.0;               ///< of the heat that a speed brings into the machine (warm_up_heat.hpp); 0: any
  double most_s = 4.0 * 3600.0;            ///< no warm-up is longer
  /// How far the machine may be from the model, one standard deviation of each source, film, joint and link: then `kept_free` is chosen so that
  /// 95 of 100 such machines stay within the tolerance (warm_up_error.hpp). 0: it is as given.
  double model_error = 0.0;
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

/// The shortest programme on machines that differ from the model.
struct HeldOnDraws {
  int n = 0, n_kept = 0;          ///< of the machines that the share kept free was chosen by
  int n_fresh = 0, n_fresh_kept = 0;  ///< of others
};

/// A strategy of correction over warm-ups at one speed.
struct CorrectedWarmUp {
  std::string strategy;
  std::vector<double> left_um;  ///< peak of what is left of the job's drift from its first row, by CorrectedWarmUps::times_s
  bool is_enough = false;       ///< at some of these times
  double least_s = 0.0;         ///< the first time at which the job stays within the tolerance
};
struct CorrectedWarmUps {
  std::string target;  ///< the displacement that is corrected; others stay as they are
  double speed_rpm = 0.0;
  double model_scatter = 0.0;  ///< of the model that strategies are given
  std::vector<double> times_s = {};
  std::vector<CorrectedWarmUp> strategies = {};  ///< without correction first
};

/// Least drift that the job can have behind a warm-up of a given time.
struct WarmUpLevel {
  double duration_s = 0.0;
  double constant_um = 0.0, staged_um = 0.0;  ///< behind one speed, behind two
};

struct WarmUpPlan {
  std::vector<std::string> channels;
  double tolerance_um = 0.0, most_speed_rpm = 0.0, most_s = 0.0, kept_free = 0.0;
  double most_power_W = 0.0;     ///< 0: any
  double power_at_most_W = 0.0;  ///< heat of the fastest speed allowed
  double model_error = 0.0;
  WarmUp at_once = {}, at_rest = {}, by_jobs = {}, constant = {}, staged = {};
  std::optional<WarmUp> finest = {};  ///< three or four speeds, where they are shorter, or where none is enough and they leave less
  std::optional<HeldOnDraws> held = {};
  std::optional<CorrectedWarmUps> corrected = {};
  [[nodiscard]] const WarmUp& best() const { return finest ? *finest : staged; }
  std::vector<WarmUpLevel> levels = {};   ///< by time
  Record job_at_once = {}, job_warm = {};  ///< the job's rows at once, and behind the shortest warm-up that is enough or comes nearest
  int n_tried = 0;                  ///< programmes run on the model
  std::string predicted_by = {}, started_from = {};
};

/// Looks for the shortest warm-ups.
///
/// One speed: for speeds up to the limit, the least time is looked for on a grid, between its points where the peak has a least, and then by halves, to
/// 0.5 %. Two speeds, of which either may be rest: the time is halved from the shortest known on, or tried upwards where none is known; at each, programmes (first speed, second speed, share of the first) are tried on a grid and the best improved by a pattern
/// search, until one is within the tolerance. Three and four: another section is put into the best, and that improved in the same way. By jobs: the job itself, part after part, until one stays within it.
///
/// @param job  has passed check_cyclogram()
/// @throws InputError  as predict_drift(), for channels that the machine has not, for limits out of range
[[nodiscard]] WarmUpPlan plan_warm_up(const scenarios::Scenario& scenario, const Cyclogram& job, const WarmUpOptions& options,
                                      const Listener& listener);

}  // namespace driftwright::studies
