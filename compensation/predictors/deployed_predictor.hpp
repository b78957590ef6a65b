#pragma once
// A predictor with all that it takes to put it on a machine. This is what is judged, what is kept in a file, and what corrects.

#include <optional>

#include "compensation/predictors/fail_safe.hpp"
#include "compensation/predictors/predictor.hpp"

namespace driftwright::compensation {

/// What a predictor of the same kind misses where it was not fitted: on one part of the training runs, fitted to the rest.
struct FoldError {
  std::string kind, name;  ///< "run", "run 2.csv" (judging/folds.hpp)
  double rms_um = 0.0;     ///< a row that it says nothing of counts as uncorrected
  double within_um = 0.0;  ///< the error that 95 % of the rows keep
};

struct DeployedPredictor {
  std::string name;          ///< "ridge, all sensors"
  std::string target;        ///< displacement that it tells, in um
  bool from_start = false;   ///< drift and temperatures count from the first row of the run
  bool is_baseline = false;  ///< what others have to beat; it has no fail-safe
  std::shared_ptr<const Predictor> predictor;
  std::vector<std::string> sensors = {};  ///< what it reads and may fail: thermometers, among them the ambient's
  std::string ambient = {};               ///< channel of the ambient in its training runs; "" where there was none
  std::string reason = {};                ///< what the fit decided, one sentence; may be empty
  std::optional<FailSafe> fail_safe = {};
  /// Half width of the 95 % prediction interval [um]: of each part of the training runs that was left out in turn the error that 95 % of its rows
  /// keep, the largest of those. None where no part could be left out.
  std::optional<double> interval_um = {};
  std::vector<FoldError> fold_errors = {};  ///< what the interval is made of, as fitted; in no file
};

/// @return the half width of the prediction interval in force [um]: interval_um over trust, for what is trusted by half says half as much;
///         none without trust, and where there is no interval
[[nodiscard]] std::optional<double> interval_in_force_um(const DeployedPredictor& deployed, double trust);

/// The correction as it goes to an axis: of repaired readings, guarded. Without a fail-safe the prediction, 0 where it says nothing.
[[nodiscard]] GuardedCorrection correct(const DeployedPredictor& deployed, const ObservedRun& run);

}  // namespace driftwright::compensation
