#include "base/no_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/quantity.hpp"
#include "base/record_channel.hpp"
#include "base/usual_ranges.hpp"

namespace driftwright {
namespace {

constexpr double kLeap_K = 100.0;        // from a row to the next: no thermometer in a machine changes so fast
constexpr std::size_t kFewestAtEnd = 3;  // readings at an end of the record, where a reading on the other side is missing
constexpr double kTimesSpan = 3.0;       // times the span of all other readings

/// Consecutive readings of one value.
struct Stretch {
  std::size_t first = 0, last = 0, n = 0;
  double value = 0.0;
};

std::vector<Stretch> stretches_of(const std::vector<double>& values) {
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    if (stretches.empty() || stretches.back().value != values[i]) stretches.push_back({i, i, 0, values[i]});
    stretches.back().last = i;
    ++stretches.back().n;
  }
  return stretches;
}

/// Full scale of 16 and 12 bits in any decimal place, and rows of nines and eights.
bool is_mark(double value) {
  double digits = std::abs(value);
  if (!(digits >= 300.0)) return false;
  for (int decimals = 0; decimals <= 3; ++decimals, digits *= 10.0) {
    const double whole = std::round(digits);
    if (std::abs(digits - whole) > 1e-9 * digits) continue;
    for (double mark : {999.0, 9999.0, 99999.0, 999999.0, 8888.0, 88888.0, 32767.0, 32768.0, 65535.0, 65536.0, 2147483647.0,
                        2147483648.0}) {
      if (whole == mark) return true;
    }
    return false;
  }
  return false;
}

struct Kind {
  bool is_temperature = false, is_absolute = false;
};

std::optional<Kind> kind_of_readings(const std::string& unit) {
  if (is_temperature_unit(unit)) return Kind{.is_temperature = true, .is_absolute = unit == "degC"};
  if (is_displacement_unit(unit)) return Kind{};
  return std::nullopt;
}

bool is_outside(double value, const Kind& kind) {
  const UsualRange& usual = usual_range(Usual::kTemperature);
  return value > usual.high || value < (kind.is_absolute ? usual.low : -usual.high);
}

/// Span of all readings except those of one value.
double span_without(const std::vector<double>& values, double value) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (double v : values) {
    if (std::isnan(v) || v == value) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  return high - low;
}

bool is_none(const Channel& channel, const Kind& kind, const std::vector<Stretch>& stretches, std::size_t s) {
  const double value = stretches[s].value;
  if (kind.is_absolute && value <= -kZeroCelsius_K) return true;
  if (kind.is_temperature ? !is_outside(value, kind) : !is_mark(value)) return false;
  const double leap = kind.is_temperature ? kLeap_K : kTimesSpan * span_without(channel.values, value);
  const bool is_first = s == 0, is_last = s + 1 == stretches.size();
  // a channel of one value has no other readings to compare; a value that is usual in kelvin is probably kelvin, which is
  // refused by name when read
  if (is_first && is_last) return stretches[s].n >= kFewestAtEnd && is_outside(value - kZeroCelsius_K, kind);
  if ((is_first || is_last) && stretches[s].n < kFewestAtEnd) return false;
  return (is_first || std::abs(value - stretches[s - 1].value) > leap) &&
         (is_last || std::abs(value - stretches[s + 1].value) > leap);
}

}  // namespace

std::vector<std::string> take_out_no_readings(Record& record) {
  std::vector<std::string> found;
  for (Channel& channel : record.channels) {
    const std::optional<Kind> kind = kind_of_readings(channel.unit);
    if (!kind) continue;
    const std::vector<Stretch> stretches = stretches_of(channel.values);
    std::vector<Stretch> none;
    for (std::size_t s = 0; s < stretches.size(); ++s) {
      if (is_none(channel, *kind, stretches, s)) none.push_back(stretches[s]);
    }
    if (none.empty()) continue;
    std::size_t n = 0;
    for (const Stretch& stretch : none) {
      n += stretch.n;
      for (std::size_t i = stretch.first; i <= stretch.last; ++i)
        channel.values[i] = std::numeric_limits<double>::quiet_NaN();
    }
    const auto minutes = [&](std::size_t row) { return (record.time_s[row] - record.time_s.front()) / 60.0; };
    found.push_back(
        fmt::format("{} reads {:g} {} {}: an open or broken sensor, or an instrument's mark for no reading; {} left out",
                    channel.header(), none.front().value, channel.unit,
                    n == 1 ? fmt::format("at {:.4g} min", minutes(none.front().first))
                           : fmt::format("{}in {} rows from {:.4g} to {:.4g} min", none.size() > 1 ? "and the like " : "", n,
                                         minutes(none.front().first), minutes(none.back().last)),
                    n == 1 ? "it is" : "these readings are"));
  }
  return found;
}

}  // namespace driftwright
