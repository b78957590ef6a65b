#pragma once
// Applies correct() row by row while a run goes on.

#include "compensation/predictors/control_tables.hpp"
#include "compensation/predictors/deployed_predictor.hpp"

namespace driftwright::compensation {

/// The correction of one row.
struct FollowedCorrection {
  double prediction_um = 0.0;  ///< NaN without a prediction
  double correction_um = 0.0;  ///< in force, guarded
  double trust = 1.0;          ///< factor on the prediction, 0 to 1
  /// Half width of the 95 % interval of the drift about the correction [um]: the predictor's half width divided by the
  /// smallest trust of the last hours (kRemembersDoubt_s), at least kNormal95 of the predictor's own deviations, plus the
  /// distance from the prediction to the correction, which may be faded, clamped or slewed. None without trust, and if the
  /// predictor has no interval.
  std::optional<double> interval_um = {};
  std::optional<double> half_width_um = {};  ///< of that, without the distance from the prediction to the correction
  /// Of a blend whose weights move with probings: what each member may send to the axis (control/probe_members.h).
  std::vector<double> members_um = {};
};

/// A deployed predictor during one run. The predictor must outlive it.
class DeployedFollower {
 public:
  explicit DeployedFollower(const DeployedPredictor& deployed);

  /// Takes the next row, the last row that the run has, and replaces its doubted readings in `run` by values computed from
  /// the others. Gives row by row the same as correct() for the whole run.
  /// @throws InputError  for readings that lack an input or have it in another unit
  FollowedCorrection next(MachineRun& run);

  /// The inputs that are doubted in this row, in words: by the fail-safe, or rejected by the predictor.
  [[nodiscard]] std::vector<std::string> doubted() const;
  [[nodiscard]] const Follower& follower() const { return *follower_; }

  /// As Follower::memory(). @throws std::logic_error  the same
  [[nodiscard]] std::vector<double> memory() const;
  void recall(std::span<const double> memory);

 private:
  const DeployedPredictor& deployed_;
  std::unique_ptr<Follower> follower_;
  std::optional<FailSafeTable> table_;
  double least_trust_ = 1.0;  ///< of lately
  drift_state repair_{}, guard_{};
  std::vector<drift_input_state> inputs_;
  std::vector<double> room_, read_, repaired_;
  std::vector<std::size_t> channel_;  ///< of each guard
};

}  // namespace driftwright::compensation
