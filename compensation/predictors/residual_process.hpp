#pragma once
// What a correction leaves, as a random process that fades, and its estimate from probings (control/probe_feedback.h has the
// formulas, control/probe_members.h those of several predictors): fit of the process, and the filter with its settings.

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compensation/control/probe_members.h"

namespace driftwright::compensation {

struct ResidualProcess {
  double deviation_um = 0.0;
  double time_constant_s = 0.0;
  double reading_um = 0.0;  ///< white noise beside the process in the series of the fit, 1 sigma
};

/// What one member of a blend leaves.
struct MemberResidual {
  std::string name;  ///< of its strategy
  ResidualProcess process;
};

/// The probe that measures an axis now and then.
struct Probe {
  double noise_um = 1.0;  ///< of a probing, 1 sigma
  double lag_s = 0.0;     ///< from the touch until its value is known
};

/// Measured minus predicted over a stretch of time.
struct ResidualSeries {
  std::vector<double> time_s, off_um;  ///< rising times, at least two rows
};

/// The most likely process of some series, about zero. Time constants from the mean step to ten times the longest series
/// are tried: what never fades in a series is an offset.
/// @param reading_um  white noise of the measured values, 1 sigma
/// @return none for less than ten rows
[[nodiscard]] std::optional<ResidualProcess> fit_residual_process(std::span<const ResidualSeries> series, double reading_um);

/// The settings of the filter in control/probe_feedback.h.
/// @param is_known  the residual is 0 at the start, because the drift counts from there
[[nodiscard]] probe_process probe_process_of(const ResidualProcess& process, const Probe& probe, bool is_known);

/// The residual during a run, by the C code of controls; of one predictor, or of several with weights that move with their
/// losses at probings (control/probe_members.h). The first one's prediction is the one that the residual counts from.
class ProbeFeedback {
 public:
  ProbeFeedback(const ResidualProcess& process, const Probe& probe, bool is_known)
      : ProbeFeedback(std::vector<probe_process>{probe_process_of(process, probe, is_known)}) {}
  /// @param processes  one for each predictor, at least one
  explicit ProbeFeedback(std::vector<probe_process> processes)
      : processes_(std::move(processes)), members_(processes_.size()) {}

  /// A row. @param correction_um  in force until now @param step_s  since the row before; of no account in the first one
  void row(double prediction_um, double correction_um, double step_s) {
    row(std::span(&prediction_um, 1), correction_um, step_s);
  }
  /// @param predictions_um  of each predictor; NaN: the one of the row before
  /// @throws std::logic_error  for another number of predictions
  void row(std::span<const double> predictions_um, double correction_um, double step_s);
  /// A probing of the axis without correction, and of the corrected axis. @return whether it was taken; state() says more
  bool probe_drift_um(double drift_um) {
    return is_taken(probe_members_drift(processes_.data(), members_.data(), n(), drift_um));
  }
  bool probe_left_um(double left_um) {
    return is_taken(probe_members_left(processes_.data(), members_.data(), n(), left_um));
  }

  /// Expected after some time, and its standard deviation.
  [[nodiscard]] double estimate_um(double ahead_s = 0.0) const {
    return probe_members_expected_um(processes_.data(), members_.data(), n(), ahead_s);
  }
  [[nodiscard]] double deviation_um(double ahead_s = 0.0) const {
    return probe_members_deviation_um(processes_.data(), members_.data(), n(), ahead_s);
  }
  /// Of the first predictor.
  [[nodiscard]] const probe_process& process() const { return processes_.front(); }
  /// Of the predictor that led at the last probing.
  [[nodiscard]] const probe_state& state() const { return *probe_leading(members_.data(), n()); }
  [[nodiscard]] int n_refused() const { return members_.front().n_refused; }
  /// Weight, last prediction and filter of each.
  [[nodiscard]] const std::vector<probe_member>& members() const { return members_; }

  /// All that it remembers. @throws std::logic_error  from recall(), for numbers that are no memory
  [[nodiscard]] std::vector<double> memory() const;
  void recall(std::span<const double> memory);

 private:
  [[nodiscard]] int n() const { return static_cast<int>(members_.size()); }
  static bool is_taken(int verdict) { return verdict == PROBE_TAKEN || verdict == PROBE_JUMP; }
  std::vector<probe_process> processes_;
  std::vector<probe_member> members_;  // all zero before the first row
};

}  // namespace driftwright::compensation
