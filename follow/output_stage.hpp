#pragma once
// The last thing before an axis: while rows are well, the correction as the predictor gives it; while they are not, held, then faded; never faster
// than the slew limit.

#include "follow/stream_row.hpp"

namespace driftwright::follow {

struct OutputSettings {
  double most_rate_um_s = 1.0;  ///< slew limit
  double hold_s = 300.0;  ///< so long without a row that is taken, or without a speed or an ambient, the correction holds
  double fade_s = 600.0;  ///< time constant with which authority is lost then, and won again
};

class OutputStage {
 public:
  struct State {
    double correction_um = 0.0;  ///< in force
    double wanted_um = 0.0;      ///< as the predictor gave it last
    double authority = 1.0;      ///< 0 to 1, that it is multiplied by
    double silent_s = 0.0;       ///< since the last row that was taken
    double step_s = 0.0;         ///< before that row
  };
  explicit OutputStage(const OutputSettings& settings) : settings_(settings) {}

  /// A row was taken. @param step_s  since the last call of any. @param drive_age_s  since what drives the machine was last given: beyond most_age_s() authority is lost
  double take(double wanted_um, double step_s, double drive_age_s = 0.0);
  /// So long the model may go on with the last speed and ambient: a hold, and as many steps of rows as count as missing ones.
  [[nodiscard]] double most_age_s() const { return settings_.hold_s + kMissingSteps * state_.step_s; }
  /// No row was taken for so long. @return the correction in force
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
