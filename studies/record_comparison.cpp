#include "studies/record_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.hpp"
#include "compensation/sensors/interpolate.hpp"

namespace driftwright::studies {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

const Channel* partner(const Record& record, const Channel& channel) {
  for (const Channel& other : record.channels) {
    if (other.name == channel.name && other.unit == channel.unit) return &other;
  }
  return nullptr;
}

ChannelDifference difference(const std::vector<double>& time_s, const Channel& first, const std::vector<double>& second) {
  ChannelDifference d{.name = first.name, .unit = first.unit};
  double squares = 0.0, low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const double x = second[i] - first.values[i];
    if (std::isnan(x)) continue;
    ++d.n_rows;
    squares += x * x;
    low = std::min(low, first.values[i]);
    high = std::max(high, first.values[i]);
    d.at_end = x;
    if (std::abs(x) <= std::abs(d.largest)) continue;
    d.largest = x;
    d.largest_at_s = time_s[i];
  }
  if (d.n_rows == 0) {
    d.rms = d.largest = d.at_end = d.range = kNone;
    return d;
  }
  d.rms = std::sqrt(squares / d.n_rows);
  d.range = high - low;
  return d;
}

}  // namespace

RecordComparison compare_records(const Record& first, const Record& second) {
  RecordComparison c{.first = first, .second_at_rows = {.source = second.source, .time_s = first.time_s, .channels = {}}};
  if (first.time_s.back() < second.time_s.front() || second.time_s.back() < first.time_s.front())
    throw InputError(fmt::format("{} is from {:g} to {:g} s, {} from {:g} to {:g} s; they share no stretch of time",
                                 first.source, first.time_s.front(), first.time_s.back(), second.source,
                                 second.time_s.front(), second.time_s.back()));
  for (const Channel& channel : first.channels) {
    const Channel* other = partner(second, channel);
    if (!other) {
      c.only_first.push_back(channel.header());
      continue;
    }
    Channel at_rows{channel.name, channel.unit, {}};
    for (double t_s : first.time_s) {
      const bool reached = t_s >= second.time_s.front() && t_s <= second.time_s.back();
      at_rows.values.push_back(reached ? compensation::interpolate(second.time_s, other->values, t_s) : kNone);
    }
    c.channels.push_back(difference(first.time_s, channel, at_rows.values));
    c.second_at_rows.channels.push_back(std::move(at_rows));
  }
  for (const Channel& channel : second.channels) {
    if (!partner(first, channel)) c.only_second.push_back(channel.header());
  }
  if (c.channels.empty())
    throw InputError(fmt::format("{} and {} have no channel of the same name and unit", first.source, second.source));
  return c;
}

}  // namespace driftwright::studies
