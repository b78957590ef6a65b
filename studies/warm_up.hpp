#pragma once
// How long a machine must warm up before its next job stays within a tolerance, and which programme of speeds is the
// shortest.
//
// A job's drift counts from its first row, because the tool is set there. Every programme is run on the predicting model
// (prediction.hpp), from the machine's present state, with the ambient continued as by job_series().

#include <optional>
#include <string>
#include <vector>

#include "studies/prediction.hpp"

namespace driftwright::studies {

struct WarmUpOptions {
  PredictionOptions from = {};             ///< run before, pause after it, model; `parts` and `between` are the job's
  std::vector<std::string> channels = {};  ///< displacements to judge; empty: all
  double tolerance_um = 10.0;              ///< > 0
  double kept_free = 0.0;                  ///< share of the tolerance kept free for model errors, 0 to below 1
  double most_speed_rpm = 0.0;             ///< 0: the fastest of the scenario and the job
  double most_power_W = 0.0;               ///< limit of the heat that a speed causes (warm_up_heat.hpp); 0: none
  double most_s = 4.0 * 3600.0;            ///< longest warm-up
  /// Scatter of the machine against the model, standard deviation of each source, film, joint and link: `kept_free` is
  /// then chosen so that 95 of 100 such machines stay within the tolerance (warm_up_error.hpp). 0: `kept_free` is used as
  /// given.
  double model_error = 0.0;
};

/// The job after one way to begin it.
struct WarmUp {
  std::string way = {};                           ///< in words
  std::vector<Cyclogram::Section> sections = {};  ///< before the job; empty: the job begins at once
  bool is_enough = false;                         ///< whether the job then stays within the tolerance
  double peak_um = 0.0;                           ///< of the job's drift from its first row
  std::string peak_channel = {};
  [[nodiscard]] double duration_s() const;
};

/// The shortest programme, tested on machines that differ from the model.
struct HeldOnDraws {
  int n = 0, n_kept = 0;              ///< machines that `kept_free` was chosen by, and those that keep the tolerance
  int n_fresh = 0, n_fresh_kept = 0;  ///< the same for other machines
};

/// A strategy of correction, after warm-ups at one speed.
struct CorrectedWarmUp {
  std::string strategy;
  std::vector<double> left_um;  ///< peak of the corrected drift of the job from its first row, for CorrectedWarmUps::times_s
  bool is_enough = false;       ///< at some of these times
  double least_s = 0.0;         ///< the first time at which the job stays within the tolerance
};
struct CorrectedWarmUps {
  std::string target;  ///< the corrected displacement; others are unchanged
  double speed_rpm = 0.0;
  double model_scatter = 0.0;  ///< of the model that strategies get
  std::string model = {};      ///< "linearised at 30 °C" where its laws of temperature are; else empty
  std::vector<double> times_s = {};
  std::vector<CorrectedWarmUp> strategies = {};  ///< the first is without correction
};

/// The least drift of the job after a warm-up of a given time.
struct WarmUpLevel {
  double duration_s = 0.0;
  double constant_um = 0.0, staged_um = 0.0;  ///< after one speed, after two
};

struct WarmUpPlan {
  std::vector<std::string> channels;
  double tolerance_um = 0.0, most_speed_rpm = 0.0, most_s = 0.0, kept_free = 0.0;
  double most_power_W = 0.0;     ///< 0: no limit
  double power_at_most_W = 0.0;  ///< heat of the fastest speed allowed
  double model_error = 0.0;
  WarmUp at_once = {}, at_rest = {}, by_jobs = {}, constant = {}, staged = {};
  std::optional<WarmUp> finest = {};  ///< three or four speeds, if shorter or, with none enough, of less drift
  std::optional<HeldOnDraws> held = {};
  std::optional<CorrectedWarmUps> corrected = {};
  [[nodiscard]] const WarmUp& best() const { return finest ? *finest : staged; }
  std::vector<WarmUpLevel> levels = {};    ///< by time
  Record job_at_once = {}, job_warm = {};  ///< rows of the job at once, and after the best warm-up
  int n_tried = 0;                         ///< programmes run on the model
  std::string predicted_by = {}, started_from = {};
};

/// Searches the shortest warm-ups.
///
/// One speed: for speeds up to the limit, the least time is searched on a grid, between its points where the peak has a
/// minimum, and then by bisection, to 0.5 %. Two speeds, of which either may be rest: the time is halved from the
/// shortest known time, or increased if none is known; at each time, programmes (first speed, second speed, share of the
/// first) are tried on a grid and the best is improved by a pattern search, until one is within the tolerance. Three and
/// four speeds: another section is inserted into the best programme, which is improved in the same way. By jobs: the job
/// itself, part after part, until one part stays within the tolerance.
///
/// @param job  has passed check_cyclogram()
/// @throws InputError  as predict_drift(), for channels that the machine does not have, and for limits out of range
[[nodiscard]] WarmUpPlan plan_warm_up(const scenarios::Scenario& scenario, const Cyclogram& job,
                                      const WarmUpOptions& options, const Listener& listener);

}  // namespace driftwright::studies
