#pragma once
// Strategies x conditions: the drift that each leaves on runs that it was not fitted on, and whether it may be deployed on a
// machine.

#include "compensation/judging/choice.hpp"
#include "compensation/judging/probed_run.hpp"
#include "compensation/judging/strategies.hpp"
#include "compensation/predictors/score.hpp"
#include "compensation/sensors/thermometers.hpp"

namespace driftwright::compensation {

/// A run to judge on.
struct JudgedRunOfMachine {
  std::string family, season, name;
  MachineRun run;  ///< readings as the instruments give them, with the true target
};

struct MatrixSettings {
  StrategySettings strategies;
  double tolerance_um = 10.0;
  /// Share of a run after which one sensor fails, each in turn and in each way; none: no failures.
  std::optional<double> fails_at;
  std::string fails_in;   ///< season of these failures
  std::string elsewhere;  ///< channel that a sensor reads after it has fallen off; empty: this failure is left out
};

/// One strategy on one run, with all sensors intact or one failed.
struct Case {
  std::size_t run = 0;             ///< index of the judged run
  std::string failed;              ///< "t05 stuck"; empty: none
  Score before, after;             ///< of the drift; of what remains with the correction in force
  double peak_unguarded_um = 0.0;  ///< what remains with the prediction without fail-safe; infinite where it is missing
  double rms_unguarded_um = 0.0;   ///< the same, over the rows with a prediction
  double harm_um = 0.0;  ///< largest excess of the remaining error over the error without correction, at one moment
  double first_hour_um = 0.0,
         whole_um = 0.0;  ///< ranges of the remaining error within 60 min and in total, as ISO 230-3 defines them for drift
  /// Share of the rows with a prediction interval in force whose drift is inside it; NaN without such rows.
  double covered = 0.0;
  std::vector<std::string> events;  ///< of the fail-safe
  std::vector<ProbedRun> probed;    ///< what remains if the axis is probed, too: for each interval; empty: not judged
  /// The same at the first interval with a probe that fails where sensors do (half-way by default): stuck, and with an error
  /// of the tolerance. Only with all sensors intact.
  std::optional<ProbedRun> stuck_probe = {}, biased_probe = {};

  [[nodiscard]] double left() const { return after.peak_abs / before.peak_abs; }
};

enum class Safety { kSafe, kWithinLimits, kUnsafe };
/// "safe to deploy", "safe within limits", "unsafe".
[[nodiscard]] const char* word(Safety safety);

/// In how many cells of the matrix (cyclogram x ambient x failed sensor) a strategy keeps the tolerance.
struct KeptCells {
  int n_intact = 0, n_kept_intact = 0;  ///< with all sensors intact
  int n_failed = 0, n_kept_failed = 0;  ///< with one failed
  /// Where it does not: "on 'noon' (summer)" for each run, "with t03 stuck" for each failure. At most three of each sort.
  std::vector<std::string> not_kept = {};
  int n_not_kept = 0;  ///< runs and failures where it does not, also those that are not listed

  [[nodiscard]] int n() const { return n_intact + n_failed; }
  [[nodiscard]] int n_kept() const { return n_kept_intact + n_kept_failed; }
};

/// All cases of one strategy.
struct JudgedStrategy {
  DeployedPredictor fitted;
  std::vector<Case> cases;
  Safety safety = Safety::kUnsafe;
  bool is_worse_than_nothing = false;  ///< in some case the RMS or peak is larger than without correction
  std::string why;                     ///< one sentence
  std::string beaten_by;               ///< baseline with a smaller RMS over all intact rows; empty: none, and for baselines
  /// Families (seasons) in which it keeps the tolerance with intact sensors, if not in all.
  std::vector<std::string> limits;
  KeptCells cells = {};
};

/// All strategies with weights that move with their losses at probings, on one run with all sensors intact or one failed.
struct WeightedCase {
  std::size_t run = 0;
  std::string failed = {};
  std::vector<ProbedRun> probed = {};  ///< for each interval
};

/// The results of all strategies.
struct StrategyMatrix {
  std::vector<MachineRun> training;
  std::vector<JudgedRunOfMachine> runs;
  std::vector<JudgedStrategy> strategies;
  std::vector<LeftOut> left_out;
  std::vector<WeightedCase> weighted = {};
  MatrixSettings settings;
  std::vector<std::string> findings = {};  ///< about the records themselves, a sentence each
  Choice choice = {};                      ///< of the strategy to deploy, from training runs alone
};

/// A case with its values over time, per row of the run's readings.
struct Judgement {
  Case scores;                        ///< without `run` and `failed`, which the matrix sets
  std::vector<double> correction_um;  ///< as sent to the axis
  std::vector<double> left_um;        ///< drift - correction; NaN where the drift is unknown
  /// The same for each member of a blend whose weights move with probings (GuardedCorrection::members_um).
  std::vector<std::vector<double>> members_left_um = {};
};
/// The strategy with what it leaves, then its members if their weights move with probings. The loan lasts as long as both.
/// @throws std::logic_error  for a strategy without a process
[[nodiscard]] std::vector<ProbedMember> probed_members(const DeployedPredictor& strategy, const Judgement& judged);
/// Judges one predictor on one run. @param drift_um true, per row of the run's readings; from the start if the predictor
/// counts so
[[nodiscard]] Judgement judge(const DeployedPredictor& strategy, const MachineRun& run, const std::vector<double>& drift_um);

/// Fits on `training`, judges on `runs`. Cases run in parallel on all cores; the result does not depend on their number.
[[nodiscard]] StrategyMatrix judge_strategies(const MatrixSettings& settings, std::vector<MachineRun> training,
                                              std::vector<JudgedRunOfMachine> runs);

/// The worst values over some cases of a strategy.
struct Worst {
  const Case* peak = nullptr;  ///< largest peak left; null: no case
  double left = 0.0;           ///< largest ratio of remaining peak to peak drift [-]
  double rms_um = 0.0;         ///< largest
  double covered = 1.0;        ///< smallest
  double mean_covered = 0.0;
};
[[nodiscard]] Worst worst_of(const JudgedStrategy& strategy, const std::function<bool(const Case&)>& counts);

/// RMS of the remaining error over the rows of all runs with all sensors intact [um].
[[nodiscard]] double overall_rms(const JudgedStrategy& strategy);

/// Displacements and tilts of the judged runs that strategies neither correct nor judge.
[[nodiscard]] std::vector<std::string> other_axes(const StrategyMatrix& matrix);
/// Families, or seasons, in the order of the runs.
[[nodiscard]] std::vector<std::string> families_of(const StrategyMatrix& matrix);
[[nodiscard]] std::vector<std::string> seasons_of(const StrategyMatrix& matrix);

/// The simplest strategy (no baseline, not unsafe) that keeps the tolerance in a family with intact sensors in all seasons;
/// null: none.
[[nodiscard]] const JudgedStrategy* simplest_enough(const StrategyMatrix& matrix, const std::string& family);
/// The strategy chosen from the training runs; null: none.
[[nodiscard]] const JudgedStrategy* chosen_strategy(const StrategyMatrix& matrix);
/// The strategy with the smallest RMS over the judged rows, which shows afterwards how good the choice was.
[[nodiscard]] const JudgedStrategy& best_in_hindsight(const StrategyMatrix& matrix);

}  // namespace driftwright::compensation
