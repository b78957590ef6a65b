#pragma once
// The last thing before an axis: while rows are well, the correction as the predictor gives it; while they are not, held, then faded; never faster
// than the slew limit.

namespace driftwright::follow {

struct OutputSettings {
  double most_rate_um_s = 1.0;  ///< slew limit
  double hold_s = 300.0;        ///< so long without a row that is taken, or without a drive, the correction keeps its authority
  double fade_s = 600.0;        ///< time constant with which authority is lost then, and won again
};

class OutputStage {
 public:
  struct State {
    double correction_um = 0.0;  ///< in force
    double wanted_um = 0.0;      ///< as the predictor gave it last
    double authority = 1.0;      ///< 0 to 1, that it is multiplied by
    double silent_s = 0.0;       ///< since the last row that was taken and gave the drive
  };
  explicit OutputStage(const OutputSettings& settings) : settings_(settings) {}

  /// A row was taken. @param step_s  since the last call of any
  double take(double wanted_um, double step_s);
  /// A row was taken that does not give the drive: the prediction goes on with the last one, for as long as a correction holds.
  double take_without_drive(double wanted_um, double step_s);
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
