#pragma once
// What stands between a body's temperature and the number a control works with: sampling, noise, steps, failure.

#include <cstdint>
#include <string>

#include "base/record.hpp"

namespace driftwright::compensation {

/// A thermometer instrument; all sensors of a record are read by one.
struct Thermometers {
  double noise_K = 0.0;       ///< of each reading, white, 1 sigma, >= 0
  double resolution_K = 0.0;  ///< readings are multiples of it; 0: exact
};

/// The record with its temperatures (channels in degC or K) as those thermometers give them: noise first, then rounding.
/// Other channels are as they were, missing values stay missing. Each sensor draws its own noise; the same seed gives the
/// same readings.
[[nodiscard]] Record as_read(Record record, const Thermometers& thermometers, std::uint64_t seed);

/// The record with each temperature as the mean of its readings of the last `window_s`, its own among them; missing ones count for
/// nothing. 0: as it was. It lags by half the window.
[[nodiscard]] Record running_mean(Record record, double window_s);

/// How a sensor fails.
enum class SensorFailure {
  kStuck,     ///< its reading stays what it was
  kOpen,      ///< no reading any more
  kDetached,  ///< it fell off: from then on it reads `elsewhere`
  kSwapped,   ///< its plug and that of `elsewhere` are exchanged: from then on each reads the other's place
  kRising,    ///< it reads ever more, by kSensorDrift_K_h
  kFalling,   ///< or ever less
};
/// A thermometer that ages within a run: a platinum resistor whose insulation gives way, a junction that corrodes [K/h].
inline constexpr double kSensorDrift_K_h = 2.0;

/// The record with one sensor failed from a time on (at the first row with time >= from_s).
/// @param elsewhere  channel that a detached sensor reads, or that a swapped one is exchanged with, in the sensor's unit; else unused
/// @throws InputError  when the record has no such channels, or they differ in unit
[[nodiscard]] Record with_failed_sensor(Record record, const std::string& sensor, SensorFailure failure, double from_s,
                                        const std::string& elsewhere = {});

/// The record every `period_s` from its first time on, linear between its rows and missing beside missing values; `speed`
/// holds its value until the next row instead. The last row is the last one inside the record.
/// @throws RangeError  when the period is not positive, or so short that there would be more than 2e8 samples
[[nodiscard]] Record sampled(const Record& record, double period_s);

}  // namespace driftwright::compensation
