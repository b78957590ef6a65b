#pragma once
// A predictor with everything that is needed to use it on a machine. This is what is judged, stored in a file, and used to
// correct.

#include <optional>

#include "compensation/predictors/fail_safe.hpp"
#include "compensation/predictors/predictor.hpp"
#include "compensation/predictors/residual_process.hpp"

namespace driftwright::compensation {

/// The error of a predictor of the same kind on one part of the training runs after a fit to the rest.
struct FoldError {
  std::string kind, name;  ///< "run", "run 2.csv" (judging/folds.hpp)
  double rms_um = 0.0;     ///< of what is sent: with the fail-safe, if it has one; a row without a prediction is uncorrected
  double within_um = 0.0;  ///< of the prediction alone: the error that 95 % of the rows do not exceed
};

/// The predictor and its data.
struct DeployedPredictor {
  std::string name;          ///< "ridge, all sensors"
  std::string target;        ///< displacement that it predicts, in um
  bool from_start = false;   ///< drift and temperatures count from the first row of the run
  bool is_baseline = false;  ///< a reference that others must beat; it has no fail-safe
  std::shared_ptr<const Predictor> predictor;
  std::vector<std::string> sensors = {};  ///< inputs that may fail: thermometers, including the ambient's
  std::string ambient = {};               ///< channel of the ambient in its training runs; "" without one
  std::string reason = {};                ///< what the fit decided, one sentence; may be empty
  std::string model = {};                 ///< of one with physics: in which way its model is approximate; may be empty
  std::optional<FailSafe> fail_safe = {};
  /// Half width of the 95 % prediction interval [um]: for each part of the training runs that was left out in turn, the
  /// error that 95 % of its rows do not exceed; the largest of these. None if no part could be left out.
  std::optional<double> interval_um = {};
  /// What it leaves on parts of the training runs that were left out, for probings; none if no part could be left out.
  std::optional<ResidualProcess> residual = {};
  Probe probe = {};  ///< that the axis is probed with
  /// Of a mean of formulas, what each leaves, in the order of Predictor::members(): with probings, weights among the mean
  /// itself and its members move with their losses. Empty: the mean stays as it is.
  std::vector<MemberResidual> member_residuals = {};
  /// Largest residual on parts of the training runs that were left out, with one of its sensors failed [um]; none: not
  /// tried.
  /// Not stored in files.
  std::optional<double> failed_um = {};
  std::vector<FoldError> fold_errors = {};  ///< the data of the interval, from the fit; not stored in files
};

/// The first input that must be guarded and has no guard in the fail-safe; none: the predictor may be deployed. What is not
/// guarded is neither written to a file nor read from one.
[[nodiscard]] std::optional<Input> unguarded_input(const DeployedPredictor& deployed);

/// The settings of the filters of probings: of the predictor itself, then of its members if their weights move.
/// @param probe  that the axis is probed with
/// @throws std::logic_error  for a predictor without a process
[[nodiscard]] std::vector<probe_process> probe_processes_of(const DeployedPredictor& deployed, const Probe& probe);

/// @param own_um  the predictor's own standard deviation (Follower::deviation_um())
/// @return the half width of the prediction interval in force [um]: interval_um / trust, at least kNormal95 of its own
///         deviations; none without trust, and if there is no interval
[[nodiscard]] std::optional<double> interval_in_force_um(const DeployedPredictor& deployed, double trust,
                                                         std::optional<double> own_um = {});

/// The drift of a run as predicted from repaired readings, before clamp and slew limit.
struct PredictedDrift {
  Repaired readings;                                 ///< with the trust that readings and predictor deserve
  std::vector<double> drift_um;                      ///< per row; NaN without a prediction
  std::vector<std::optional<double>> deviation_um;   ///< per row: Follower::deviation_um()
  std::vector<std::vector<double>> members_um = {};  ///< per row: Follower::members_um()
};
[[nodiscard]] PredictedDrift predict(const Predictor& predictor, const FailSafe& safe, const MachineRun& run);

/// The correction as sent to an axis: computed from repaired readings, and guarded. Without a fail-safe it is the
/// prediction, or 0 without one. Its members, if weights among them move, are those of Follower::members_um() as they may go
/// to an axis (control/probe_members.h). Its interval is that in force, plus the distance from the prediction to the
/// correction.
[[nodiscard]] GuardedCorrection correct(const DeployedPredictor& deployed, const MachineRun& run);

}  // namespace driftwright::compensation
