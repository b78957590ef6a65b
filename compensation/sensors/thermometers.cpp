#include "compensation/sensors/thermometers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.hpp"
#include "base/random.hpp"
#include "base/record_channel.hpp"
#include "compensation/sensors/interpolate.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kMostSamples = 2e8;  // 1.6 GB

/// The value of the last row at or before each time.
std::vector<double> held(const Record& record, const std::vector<double>& values, const std::vector<double>& at_s) {
  std::vector<double> result;
  std::size_t row = 0;
  for (double t_s : at_s) {
    while (row + 1 < record.n_samples() && record.time_s[row + 1] <= t_s) ++row;
    result.push_back(values[row]);
  }
  return result;
}

}  // namespace

Record as_read(Record record, const Thermometers& thermometers, std::uint64_t seed) {
  const double step_K = thermometers.resolution_K;
  for (std::size_t c = 0; c < record.channels.size(); ++c) {
    Channel& channel = record.channels[c];
    if (!is_temperature_unit(channel.unit)) continue;
    Random random(seed, c);
    for (double& value : channel.values) {
      if (thermometers.noise_K > 0.0) value += thermometers.noise_K * random.normal();
      if (step_K > 0.0) value = step_K * std::round(value / step_K);
    }
  }
  return record;
}

Record running_mean(Record record, double window_s) {
  for (Channel& channel : record.channels) {
    if (!is_temperature_unit(channel.unit) || !(window_s > 0.0)) continue;
    const std::vector<double> read = channel.values;
    std::size_t first = 0;
    for (std::size_t i = 0; i < read.size(); ++i) {
      while (record.time_s[first] < record.time_s[i] - window_s - 1e-6) ++first;
      double sum = 0.0, n = 0.0;
      for (std::size_t k = first; k <= i; ++k) {
        if (std::isnan(read[k])) continue;
        sum += read[k];
        n += 1.0;
      }
      channel.values[i] = n > 0.0 ? sum / n : read[i];
    }
  }
  return record;
}

Record with_failed_sensor(Record record, const std::string& sensor, SensorFailure failure, double from_s,
                          const std::string& elsewhere) {
  const bool has_other = failure == SensorFailure::kDetached || failure == SensorFailure::kSwapped;
  Channel* other = has_other ? &changeable_channel(record, elsewhere) : nullptr;
  Channel& failed = changeable_channel(record, sensor);
  if (other && other->unit != failed.unit) {
    throw InputError(fmt::format("'{}' in {} cannot read '{}' in {}", sensor, failed.unit, elsewhere, other->unit));
  }
  double last = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    if (record.time_s[i] < from_s) {
      if (std::isfinite(failed.values[i])) last = failed.values[i];
      continue;
    }
    switch (failure) {
      case SensorFailure::kStuck:
        if (std::isnan(last)) last = failed.values[i];
        failed.values[i] = last;
        break;
      case SensorFailure::kOpen:
        failed.values[i] = std::numeric_limits<double>::quiet_NaN();
        break;
      case SensorFailure::kDetached:
        failed.values[i] = other->values[i];
        break;
      case SensorFailure::kSwapped:
        std::swap(failed.values[i], other->values[i]);
        break;
      case SensorFailure::kRising:
        failed.values[i] += kSensorDrift_K_h * (record.time_s[i] - from_s) / 3600.0;
        break;
      case SensorFailure::kFalling:
        failed.values[i] -= kSensorDrift_K_h * (record.time_s[i] - from_s) / 3600.0;
        break;
    }
  }
  return record;
}

Record sampled(const Record& record, double period_s) {
  if (!(period_s > 0.0)) throw RangeError(fmt::format("sampling period {} s must be positive", period_s));
  Record result{.source = record.source, .time_s = {}, .channels = {}};
  const double span_s = record.time_s.back() - record.time_s.front();
  const double n_wanted = std::floor(span_s / period_s * (1.0 + 1e-12)) + 1.0;
  if (!(n_wanted * static_cast<double>(record.channels.size() + 1) <= kMostSamples))
    throw RangeError(fmt::format("{} channels of '{}' every {:g} s are {:.3g} samples over {:g} h; at most {:.0e} are taken",
                                 record.channels.size(), record.source, period_s,
                                 n_wanted * static_cast<double>(record.channels.size()), span_s / 3600.0, kMostSamples));
  const auto n = static_cast<std::size_t>(n_wanted);
  for (std::size_t i = 0; i < n; ++i) {
    result.time_s.push_back(std::min(record.time_s.front() + static_cast<double>(i) * period_s, record.time_s.back()));
  }
  for (const Channel& channel : record.channels) {
    Channel out{.name = channel.name, .unit = channel.unit, .values = {}};
    if (channel.name == "speed") {
      out.values = held(record, channel.values, result.time_s);
    } else {
      for (double t_s : result.time_s) out.values.push_back(interpolate(record.time_s, channel.values, t_s));
    }
    result.channels.push_back(std::move(out));
  }
  return result;
}

}  // namespace driftwright::compensation
