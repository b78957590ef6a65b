#pragma once
// What a correction leaves, as a random process that fades, and its estimate from probings (control/probe_feedback.h has the
// formulas): fit of the process, and the filter with its settings.

#include <optional>
#include <span>
#include <vector>

#include "compensation/control/probe_feedback.h"

namespace driftwright::compensation {

struct ResidualProcess {
  double deviation_um = 0.0;
  double time_constant_s = 0.0;
  double reading_um = 0.0;  ///< white noise beside the process in the series of the fit, 1 sigma
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

/// The residual during a run, by the C code of controls.
class ProbeFeedback {
 public:
  ProbeFeedback(const ResidualProcess& process, const Probe& probe, bool is_known)
      : process_(probe_process_of(process, probe, is_known)) {}

  /// A row. @param correction_um  in force until now @param step_s  since the row before; of no account in the first one
  void row(double prediction_um, double correction_um, double step_s) {
    probe_row(&process_, &state_, prediction_um, correction_um, step_s);
  }
  /// A probing of the axis without correction, and of the corrected axis. @return whether it was taken; verdict() says more
  bool probe_drift_um(double drift_um) { return is_taken(probe_drift(&process_, &state_, drift_um)); }
  bool probe_left_um(double left_um) { return is_taken(probe_left(&process_, &state_, left_um)); }

  /// Expected after some time, and its standard deviation.
  [[nodiscard]] double estimate_um(double ahead_s = 0.0) const { return probe_expected_um(&process_, &state_, ahead_s); }
  [[nodiscard]] double deviation_um(double ahead_s = 0.0) const { return probe_deviation_um(&process_, &state_, ahead_s); }
  [[nodiscard]] const probe_process& process() const { return process_; }
  [[nodiscard]] const probe_state& state() const { return state_; }

  /// All that it remembers. @throws std::logic_error  from recall(), for numbers that are no memory
  [[nodiscard]] std::vector<double> memory() const;
  void recall(std::span<const double> memory);

 private:
  static bool is_taken(int verdict) { return verdict == PROBE_TAKEN || verdict == PROBE_JUMP; }
  probe_process process_;
  probe_state state_{};
};

}  // namespace driftwright::compensation
