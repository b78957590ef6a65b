#pragma once
// What a strategy leaves on parts of the training runs that it was not fitted to, in the way it will be used: with its
// fail-safe, learned from the other parts.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/machine_limits.hpp"
#include "compensation/judging/folds.hpp"
#include "compensation/predictors/deployed_predictor.hpp"

namespace driftwright::compensation {

/// Of each fold, the predictor fitted to the other rows; empty if it cannot be fitted to those of one fold.
using FoldPredictors = std::vector<std::shared_ptr<const Predictor>>;
[[nodiscard]] FoldPredictors fold_predictors(
    const std::function<std::shared_ptr<const Predictor>(std::span<const MachineRun>)>& fit, const FoldedRuns& folds);

/// How the readings are taken.
struct LeftOutSettings {
  std::string target;
  bool from_start = false;  ///< drift and temperatures count from the first row of each run
  CorrectionLimits limits = {};
  double drift_um = 1.0;  ///< 1 sigma of the target as measured in the training runs
};

/// Sets `fold_errors`, `interval_um` and `residual` of a strategy, and returns the room of its fail-safe: the factor on the
/// margins beyond the training data (learn_fail_safe()) with which its corrections leave the least on the folds. The
/// smallest that is tried is 1; the least of four tries is a little too small. `rms_um` of a fold is that of the guarded
/// correction, `within_um` and `interval_um` are those of the bare prediction. A baseline has no fail-safe and is judged by
/// its predictions.
double set_left_out(DeployedPredictor& strategy, const FoldPredictors& predictors, const FoldedRuns& folds,
                    const LeftOutSettings& settings);

/// The fail-safe of a predictor that was fitted to what a fold leaves, learned from the same rows.
[[nodiscard]] FailSafe fail_safe_in_fold(const Predictor& predictor, const FoldedRuns& folds, std::size_t fold,
                                         const LeftOutSettings& settings, double room);

/// The fail-safe of a fitted strategy. @param training  runs whose lead-in is followed but sets no limits
[[nodiscard]] FailSafe fail_safe_of(const Predictor& predictor, std::span<const MachineRun> training,
                                    const LeftOutSettings& settings, double room);

}  // namespace driftwright::compensation
