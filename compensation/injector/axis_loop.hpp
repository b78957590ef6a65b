#pragma once
// Thermal drift corrected through the injector, with the whole chain from a body's temperature to the tool:
// thermometers -> predictor -> um -> counts -> injector -> control -> axis. It shows the error that each link leaves.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"
#include "compensation/injector/injected_axis.hpp"
#include "compensation/sensors/thermometers.hpp"

namespace driftwright::compensation {

/// The axis moves to and fro, as in a program of many passes. With stroke 0 it does not move.
struct AxisMotion {
  double stroke_um = 0.0;
  double feed_um_s = 10e3;
  double every_s = 60.0;  ///< from one pass to the next, there and back in turn

  /// Time from the start of a pass until the axis is at rest again: the travel at its feed, and 0.3 s to settle.
  [[nodiscard]] double busy_s() const { return stroke_um / feed_um_s + 0.3; }
};

/// The part whose growth is an error of the axis if the feedback does not measure it.
enum class GrowingPart { kScrew, kScale };

/// All parts of the chain.
struct AxisLoop {
  Feedback feedback = Feedback::kMotor;
  Encoder encoder;
  InjectorSettings injector;
  Servo servo;
  AxisMotion motion;
  double sampling_s = 1.0;    ///< period of readings, predictions and corrections
  Thermometers thermometers;  ///< noise and steps of the readings
  /// A correction changes only when it differs by this much more than half an insertion; suppresses noise.
  double hysteresis_um = 0.0;
  std::uint64_t seed = 1;  ///< of the thermometers' noise
  /// Growth of screw or scale: strain = expansion (T - T at the start) of a channel of the record, at `at_um` from the fixed
  /// bearing (screw) or the fixed end (scale). The part that the feedback does not measure adds to the displacement: the
  /// screw's growth with a motor encoder, the scale's with a scale (unseen_um()).
  std::string growing_channel;
  GrowingPart growing_part = GrowingPart::kScrew;
  double expansion_1_K = 0.0;
  double at_um = 0.0;

  /// Travel of one insertion [um].
  [[nodiscard]] double insertion_um() const { return injector.rules.quarters * encoder.quarter_um(); }
};

/// Predicted error [um] for each row of the readings, in order; NaN for no prediction: the correction then stays unchanged.
using PredictedFromReadings = std::function<std::vector<double>(const Record& readings)>;

/// Converts a requested correction into whole insertions and carries the remainder: between two calls the sum and the
/// request differ by at most half an insertion plus the hysteresis.
class CountConverter {
 public:
  explicit CountConverter(double insertion_um, double hysteresis_um = 0.0)
      : insertion_um_(insertion_um), hysteresis_um_(hysteresis_um) {}
  /// Number of insertions for a request in um; unchanged for NaN.
  std::int64_t insertions(double wish_um);

 private:
  double insertion_um_, hysteresis_um_;
  std::int64_t given_ = 0;
};

/// The axis during a series of corrections, each in force until the time of the next.
struct InjectedSeries {
  /// Position - commanded position, as the encoder measures it, just before the correction at each time.
  std::vector<double> axis_um;
  std::vector<bool> at_rest;                    ///< false: a pass is under way or has just ended
  std::vector<std::int64_t> inserted_quarters;  ///< at that moment
  std::int64_t encoder_quarters = 0;            ///< at the end: count of the encoder
  std::int64_t total_quarters = 0;              ///< quarter steps inserted, as counted by the injector
  std::int64_t waiting_quarters = 0;            ///< quarter steps of both that the output has not made yet
  std::int64_t control_quarters = 0;            ///< count at the control's input, by a separate x4 counter
  std::int64_t n_insertions = 0;
  std::int64_t control_jumps = 0;  ///< illegal transitions that the control received; must be 0
  AxisFaults faults;
};

/// Checks the sum: encoder count + inserted - waiting = control count.
/// @throws std::logic_error  if it is wrong
void require_ledger(const InjectedSeries& series);

/// @param time_s         strictly increasing
/// @param correction_um  requested at each time
/// @throws InputError    when the series differ in length
[[nodiscard]] InjectedSeries drive_axis(const AxisLoop& loop, std::span<const double> time_s,
                                        std::span<const double> correction_um);

/// The error that remains when one more cause of error is included, in the order of the chain.
struct ErrorStage {
  std::string cause;  ///< "model", "thermometers", ...
  std::string words;
  double rms_um = 0.0;
  double peak_um = 0.0;
};

/// What the chain leaves.
struct AxisLoopResult {
  std::vector<double> time_s;  ///< every sampling_s
  std::vector<double> before_um, predicted_um,
      after_um;  ///< tool errors at the samples, without and with the injector; and the predicted error
  std::vector<double> inserted_um;
  std::vector<bool> at_rest;
  /// First the error without correction; then causes of error are included one after another: model, thermometers, sampling,
  /// resolution, rate limit, axis. The last is after_um. Only times at rest after the first sample count.
  std::vector<ErrorStage> stages;
  InjectedSeries with;  ///< the axis with the injector active
};

/// Runs a record through the loop.
///
/// Each cause includes all before it: `model` corrects continuously by the predictor with true temperatures; `thermometers`
/// uses readings with noise and steps; `sampling` holds each correction for one period and evaluates the error just before
/// the next one; `resolution` rounds to whole insertions, with the hysteresis; `rate limit` limits their change to the
/// largest slew; `axis` simulates encoder, injector, counter and servo.
///
/// @param truth    record with true temperatures and the displacement
/// @param channel  displacement in um = error of the tool
/// @throws InputError  when a channel is missing or has a missing value, or when only the first sample is at rest
[[nodiscard]] AxisLoopResult run_axis_loop(const AxisLoop& loop, const Record& truth, const std::string& channel,
                                           const PredictedFromReadings& predicted);

}  // namespace driftwright::compensation
