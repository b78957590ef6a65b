#pragma once
// Strategies x conditions: what each leaves of the drift on runs that it was not fitted on, and whether it may go on a machine.

#include "compensation/judging/strategies.hpp"
#include "compensation/predictors/score.hpp"
#include "compensation/sensors/thermometers.hpp"

namespace driftwright::compensation {

/// A run to judge on.
struct JudgedRunOfMachine {
  std::string family, season, name;
  ObservedRun run;  ///< readings as instruments give them, the target true
};

struct MatrixSettings {
  StrategySettings strategies;
  double tolerance_um = 10.0;
  std::optional<double>
      fails_at;           ///< share of a run after which one sensor fails, each in turn and in each way; none: none fails
  std::string fails_in;   ///< season in which
  std::string elsewhere;  ///< channel that a sensor reads which fell off; empty: none falls off
};

/// One strategy on one run, all sensors intact or one failed.
struct Case {
  std::size_t run = 0;             ///< index of the judged run
  std::string failed;              ///< "t05 stuck"; empty: none
  Score before, after;             ///< of the drift; of what the correction in force leaves
  double peak_unguarded_um = 0.0;  ///< of what the bare prediction leaves; infinite where it is missing
  double rms_unguarded_um = 0.0;   ///< the same, of the rows that it predicts
  double harm_um = 0.0;            ///< the most by which it leaves more than there would be without it, at one moment
  double first_hour_um = 0.0,
         whole_um = 0.0;  ///< ranges of what is left within 60 min and in all, as ISO 230-3 asks of drift
  double covered =
      0.0;  ///< of the rows with a prediction interval in force, the share whose drift is inside; NaN without any
  std::vector<std::string> events;  ///< of the fail-safe

  [[nodiscard]] double left() const { return after.peak_abs / before.peak_abs; }
};

enum class Safety { kSafe, kWithinLimits, kUnsafe };
/// "safe to deploy", "safe within limits", "unsafe".
[[nodiscard]] const char* word(Safety safety);

/// All cases of one strategy.
struct JudgedStrategy {
  DeployedPredictor fitted;
  std::vector<Case> cases;
  Safety safety = Safety::kUnsafe;
  bool is_worse_than_nothing = false;  ///< in some case more is left than without correction, by RMS or peak
  std::string why;                     ///< one sentence
  std::string beaten_by;  ///< baseline whose RMS over all intact rows is smaller; empty: none, and for baselines
  std::vector<std::string>
      limits;  ///< families (seasons) in which it keeps the tolerance with sensors intact, where not everywhere
};

struct StrategyMatrix {
  std::vector<ObservedRun> training;
  std::vector<JudgedRunOfMachine> runs;
  std::vector<JudgedStrategy> strategies;
  std::vector<LeftOut> left_out;
  MatrixSettings settings;
  std::vector<std::string> findings = {};  ///< about the records themselves, a sentence each
  Choice choice = {};                      ///< of the strategy to deploy, by training runs alone
};

/// A case with its course, per row of the run's readings.
struct Judgement {
  Case scores;                        ///< without `run` and `failed`, which are the matrix's
  std::vector<double> correction_um;  ///< as it goes to the axis
  std::vector<double> left_um;        ///< drift - correction; NaN where no drift is known
};
/// What one predictor leaves of the drift of one run. @param drift_um  per row of the run's readings, true; from the start, where it counts so
[[nodiscard]] Judgement judge(const DeployedPredictor& strategy, const ObservedRun& run,
                              const std::vector<double>& drift_um);

/// Fits on `training`, judges on `runs`. Cases go side by side on all cores; the result is the same on any number of them.
[[nodiscard]] StrategyMatrix judge_strategies(const MatrixSettings& settings, std::vector<ObservedRun> training,
                                              std::vector<JudgedRunOfMachine> runs);

/// Sets `safety`, `is_worse_than_nothing`, `why` and `limits` by the cases of a strategy; nothing where it has none.
void give_verdict(const StrategyMatrix& matrix, JudgedStrategy& strategy);

/// Over some cases of a strategy: the worst.
struct Worst {
  const Case* peak = nullptr;  ///< largest peak left; null: no case
  double left = 0.0;           ///< largest peak left over peak drift [-]
  double rms_um = 0.0;         ///< largest
  double covered = 1.0;        ///< smallest
  double mean_covered = 0.0;
};
[[nodiscard]] Worst worst_of(const JudgedStrategy& strategy, const std::function<bool(const Case&)>& counts);

/// RMS of what is left over the rows of all runs, all sensors intact [um].
[[nodiscard]] double overall_rms(const JudgedStrategy& strategy);

/// Families, or seasons, of the runs in their order.
[[nodiscard]] std::vector<std::string> families_of(const StrategyMatrix& matrix);
[[nodiscard]] std::vector<std::string> seasons_of(const StrategyMatrix& matrix);

/// The simplest strategy, no baseline and not unsafe, that keeps the tolerance in a family with intact sensors in all seasons; null: none.
[[nodiscard]] const JudgedStrategy* simplest_enough(const StrategyMatrix& matrix, const std::string& family);
/// The one that was chosen by the training runs; null: none was.
[[nodiscard]] const JudgedStrategy* chosen_strategy(const StrategyMatrix& matrix);
/// The one with the least RMS over the judged rows, known once they are; it says how good the choice was.
[[nodiscard]] const JudgedStrategy& best_in_hindsight(const StrategyMatrix& matrix);

}  // namespace driftwright::compensation
