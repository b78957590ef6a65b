#pragma once
// Errors between a body's temperature and the number that a control receives: sampling, noise, steps, failure.

#include <cstdint>
#include <string>

#include "base/record.hpp"

namespace driftwright::compensation {

/// The instrument that reads all sensors of a record.
struct Thermometers {
  double noise_K = 0.0;       ///< of each reading, white, 1 sigma, >= 0
  double resolution_K = 0.0;  ///< readings are multiples of this; 0: exact
};

/// The record with its temperatures (channels in degC or K) as these thermometers read them: first noise, then rounding.
/// Other channels are unchanged, missing values stay missing. Each sensor has independent noise; the same seed gives the
/// same readings.
[[nodiscard]] Record as_read(Record record, const Thermometers& thermometers, std::uint64_t seed);

/// The record with each temperature replaced by the mean of its readings of the last `window_s`, including its own; missing
/// ones are ignored. 0: unchanged. The mean lags by half the window.
[[nodiscard]] Record running_mean(Record record, double window_s);

/// How a sensor fails.
enum class SensorFailure {
  kStuck,     ///< its reading no longer changes
  kOpen,      ///< it has no readings
  kDetached,  ///< it fell off: from then on it reads `elsewhere`
  kSwapped,   ///< its plug and that of `elsewhere` are exchanged: from then on each reads the other's place
  kRising,    ///< its reading rises by kSensorDrift_K_h
  kFalling,   ///< its reading falls by kSensorDrift_K_h
};
/// Drift of a thermometer that ages within a run [K/h]: a platinum resistor with failing insulation, or a corroding
/// junction.
inline constexpr double kSensorDrift_K_h = 2.0;

/// The record with one sensor failed from the first row with time >= from_s.
/// @param elsewhere  channel that a detached sensor reads, or that a swapped one is exchanged with, in the sensor's unit;
///                   else unused
/// @throws InputError  when the record lacks such a channel, or the two differ in unit
[[nodiscard]] Record with_failed_sensor(Record record, const std::string& sensor, SensorFailure failure, double from_s,
                                        const std::string& elsewhere = {});

/// The record every `period_s` from its first time on, linear between its rows and missing next to missing values; `speed`
/// keeps its value until the next row instead. The last row is the last one inside the record.
/// @throws RangeError  when the period is not positive, or so short that there would be more than 2e8 samples
[[nodiscard]] Record sampled(const Record& record, double period_s);

}  // namespace driftwright::compensation
