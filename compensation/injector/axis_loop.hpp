#pragma once
// Thermal drift corrected through the injector, with everything that stands between a body's temperature and the tool:
// thermometers -> predictor -> um -> counts -> injector -> control -> axis. And which of them leaves how much.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"
#include "compensation/injector/injected_axis.hpp"
#include "compensation/sensors/thermometers.hpp"

namespace driftwright::compensation {

/// The axis works to and fro, as in a program of many passes. Without motion (stroke 0) it stands.
struct AxisMotion {
  double stroke_um = 0.0;
  double feed_um_s = 10e3;
  double every_s = 60.0;  ///< from one pass to the next, there and back in turn

  /// Time from the start of a pass until the axis is at rest again: the way at its feed, and 0.3 s to settle.
  [[nodiscard]] double busy_s() const { return stroke_um / feed_um_s + 0.3; }
};

/// Whose growth is an error of the axis if the feedback does not see it.
enum class GrowingPart { kScrew, kScale };

struct AxisLoop {
  Feedback feedback = Feedback::kMotor;
  Encoder encoder;
  InjectorSettings injector;
  Servo servo;
  AxisMotion motion;
  double sampling_s = 1.0;     ///< period of readings, predictions and corrections
  Thermometers thermometers;   ///< noise and steps of the readings
  double hysteresis_um = 0.0;  ///< a correction changes once it is this much more than half an insertion off; against noise
  std::uint64_t seed = 1;      ///< of the thermometers' noise
  /// Growth of screw or scale: strain = expansion (T - T at the start) of a channel of the record, at `at_um` from the fixed bearing
  /// (screw) or the fixed end (scale). What the feedback does not see of it is an error of the axis beside the displacement: the screw's
  /// behind a motor encoder, the scale's behind a scale (unseen_um()).
  std::string growing_channel;
  GrowingPart growing_part = GrowingPart::kScrew;
  double expansion_1_K = 0.0;
  double at_um = 0.0;

  /// Travel of one insertion [um].
  [[nodiscard]] double insertion_um() const { return injector.rules.quarters * encoder.quarter_um(); }
};

/// Predicted error [um] for each row of the readings, in their order; NaN where there is none: the correction then stays.
using PredictedFromReadings = std::function<std::vector<double>(const Record& readings)>;

/// Whole insertions for a wished correction, the rest carried: between two calls the sum of what was given and the wish differ by half
/// an insertion at most, plus the hysteresis.
class CountConverter {
 public:
  explicit CountConverter(double insertion_um, double hysteresis_um = 0.0)
      : insertion_um_(insertion_um), hysteresis_um_(hysteresis_um) {}
  /// Insertions that shall be in, for a wish in um; the same as before where it is no number.
  std::int64_t insertions(double wish_um);

 private:
  double insertion_um_, hysteresis_um_;
  std::int64_t given_ = 0;
};

/// The axis over a series of corrections, each in force from its time to the next one's.
struct InjectedSeries {
  std::vector<double>
      axis_um;  ///< axis - commanded position, as far as the encoder sees it, just before each time's own correction
  std::vector<bool> at_rest;                    ///< false: a pass is under way, or has just ended
  std::vector<std::int64_t> inserted_quarters;  ///< at that moment
  std::int64_t encoder_quarters = 0;            ///< at the end: counts in,
  std::int64_t total_quarters = 0;              ///< inserted, as the injector has it,
  std::int64_t waiting_quarters = 0;            ///< of both those that the output has yet to make,
  std::int64_t control_quarters = 0;            ///< and counts out, by a x4 counter of its own
  std::int64_t n_insertions = 0;
  std::int64_t control_jumps = 0;  ///< illegal transitions that the control saw; 0, or there is a bug
  AxisFaults faults;
};

/// The ledger: counts in + inserted - waiting = counts out.
/// @throws std::logic_error  when it is not so
void require_ledger(const InjectedSeries& series);

/// @param time_s         strictly increasing
/// @param correction_um  wished at each time
/// @throws InputError    when the series differ in length
[[nodiscard]] InjectedSeries drive_axis(const AxisLoop& loop, std::span<const double> time_s,
                                        std::span<const double> correction_um);

/// What is left of the error when one cause more is at work, in the order of the chain.
struct ErrorStage {
  std::string cause;  ///< "model", "thermometers", ...
  std::string words;
  double rms_um = 0.0;
  double peak_um = 0.0;
};

struct AxisLoopRun {
  std::vector<double> time_s;  ///< every sampling_s
  std::vector<double> before_um, predicted_um,
      after_um;  ///< tool errors at the samples, with the injector in bypass and at work; and what it was told
  std::vector<double> inserted_um;
  std::vector<bool> at_rest;
  /// First the error before any correction; then causes switched on one after another: model, thermometers, sampling, resolution,
  /// rate limit, axis. The last is after_um. At rest alone, after the first sample.
  std::vector<ErrorStage> stages;
  InjectedSeries with;  ///< the axis with the injector at work
};

/// Runs a record through the loop.
///
/// Causes, each with all before it: `model` corrects at each moment by the predictor on true temperatures; `thermometers` on readings
/// with noise and steps; `sampling` holds each correction for one period, so the error is looked at just before the next one;
/// `resolution` rounds it to whole insertions, by the hysteresis; `rate limit` lets them change by the largest slew; `axis` is the simulation of
/// encoder, injector, counter and servo.
///
/// @param truth    record with true temperatures and the displacement
/// @param channel  displacement = error of the tool, um
/// @throws InputError  when a channel is missing or is no number somewhere, or when no sample but the first is at rest
[[nodiscard]] AxisLoopRun run_axis_loop(const AxisLoop& loop, const Record& truth, const std::string& channel,
                                        const PredictedFromReadings& predicted);

}  // namespace driftwright::compensation
