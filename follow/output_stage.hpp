#pragma once
// The last stage before an axis: while rows arrive, it passes the predictor's correction on; without rows it holds the
// correction, then fades it; it never changes faster than the slew limit.

#include "base/machine_limits.hpp"
#include "follow/stream_row.hpp"

namespace driftwright::follow {

struct OutputSettings {
  double most_rate_um_s = 1.0;   ///< slew limit
  double hold_s = 300.0;         ///< the correction holds this long without rows, or without speed or ambient
  double fade_s = 600.0;         ///< time constant with which authority is then lost, and regained later
  CorrectionLimits limits = {};  ///< of the machine: of the correction, and of its change in one step
};

class OutputStage {
 public:
  struct State {
    double correction_um = 0.0;  ///< in force
    double wanted_um = 0.0;      ///< last value of the predictor
    double authority = 1.0;      ///< factor on it, 0 to 1
    double silent_s = 0.0;       ///< since the last row that was taken
    double step_s = 0.0;         ///< step before that row
  };
  explicit OutputStage(const OutputSettings& settings) : settings_(settings) {}

  /// Takes the correction of a row. @param step_s  time since the last call of take() or wait()
  /// @param drive_age_s  age of the drive and ambient; beyond most_age_s() authority is lost
  double take(double wanted_um, double step_s, double drive_age_s = 0.0);
  /// How long the model may continue with the last speed and ambient: the hold, plus the steps that count as missing
  /// rows.
  [[nodiscard]] double most_age_s() const { return settings_.hold_s + kMissingSteps * state_.step_s; }
  /// No row was taken during the last `step_s`. @return the correction in force
  double wait(double step_s);
  [[nodiscard]] const State& state() const { return state_; }
  void recall(const State& state) { state_ = state; }
  [[nodiscard]] const OutputSettings& settings() const { return settings_; }

 private:
  double move(double step_s);
  OutputSettings settings_;
  State state_;
};

}  // namespace driftwright::follow
