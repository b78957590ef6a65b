#pragma once
// What correct() does to a whole run, row by row while it goes on.

#include "compensation/predictors/control_tables.hpp"
#include "compensation/predictors/deployed_predictor.hpp"

namespace driftwright::compensation {

/// The correction of one row.
struct FollowedCorrection {
  double prediction_um = 0.0;  ///< NaN where nothing can be said
  double correction_um = 0.0;  ///< in force, guarded
  double trust = 1.0;          ///< 0 to 1, that the prediction was multiplied by
  /// Half width of the 95 % interval of the drift about the correction [um]. It is the predictor's own half width divided by the least trust of the last
  /// hours (kRemembersDoubt_s), plus the distance from the prediction to the correction, which may be faded, clamped or slewed. None without trust, and where none
  /// was learned.
  std::optional<double> interval_um = {};
};

/// Time constant with which a doubt is forgotten: a shift. What was wrong with a model is still wrong with it when its filter has adapted.
inline constexpr double kRemembersDoubt_s = 8.0 * 3600.0;

/// A deployed predictor on its way through one run. The predictor outlives it.
class DeployedFollower {
 public:
  explicit DeployedFollower(const DeployedPredictor& deployed);

  /// Takes the next row, the last one that the run has; its doubted readings are replaced there by what the others lead to. Row by row what
  /// correct() gives of the whole run.
  /// @throws InputError  for readings that lack an input or have it in another unit
  FollowedCorrection next(ObservedRun& run);

  /// Inputs that are doubted in the row, in words: by the fail-safe, or given up by the predictor.
  [[nodiscard]] std::vector<std::string> doubted() const;
  [[nodiscard]] const Follower& follower() const { return *follower_; }

  /// As Follower has it. @throws std::logic_error  the same
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
