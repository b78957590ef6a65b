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

/// The values of a channel at other times; NaN beyond its own.
std::vector<double> values_at(const Record& record, const Channel& channel, const std::vector<double>& time_s) {
  std::vector<double> values;
  for (double t_s : time_s) {
    const bool reached = t_s >= record.time_s.front() && t_s <= record.time_s.back();
    values.push_back(reached ? compensation::interpolate(record.time_s, channel.values, t_s) : kNone);
  }
  return values;
}

std::optional<RecordBand> band_at(const std::optional<RecordBand>& band, const std::vector<double>& time_s) {
  if (!band) return std::nullopt;
  RecordBand at{.limits = {.source = band->limits.source, .time_s = time_s, .channels = {}}, .words = band->words};
  for (const Channel& limit : band->limits.channels)
    at.limits.channels.push_back({limit.name, limit.unit, values_at(band->limits, limit, time_s)});
  return at;
}

/// Share of the rows with a value in which it is within the band of a channel; none without rows or without a band of it.
std::optional<double> share_in_band(const std::optional<RecordBand>& band, const std::string& channel,
                                    const std::vector<double>& values) {
  const Channel* low = band ? band->low(channel) : nullptr;
  if (!low) return std::nullopt;
  const std::vector<double>& high = band->high(channel)->values;
  int n_rows = 0, n_within = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i] + low->values[i] + high[i])) continue;
    ++n_rows;
    n_within += values[i] >= low->values[i] && values[i] <= high[i] ? 1 : 0;
  }
  if (n_rows == 0) return std::nullopt;
  return static_cast<double>(n_within) / n_rows;
}

}  // namespace

RecordComparison compare_records(const Record& first, const Record& second, const std::optional<RecordBand>& first_band,
                                 const std::optional<RecordBand>& second_band) {
  RecordComparison c{.first = first, .second_at_rows = {.source = second.source, .time_s = first.time_s, .channels = {}}};
  if (first.time_s.back() < second.time_s.front() || second.time_s.back() < first.time_s.front())
    throw InputError(fmt::format("{} is from {:g} to {:g} s, {} from {:g} to {:g} s; they share no stretch of time",
                                 first.source, first.time_s.front(), first.time_s.back(), second.source,
                                 second.time_s.front(), second.time_s.back()));
  c.first_band = band_at(first_band, first.time_s);
  c.second_band = band_at(second_band, first.time_s);
  for (const Channel& channel : first.channels) {
    const Channel* other = partner(second, channel);
    if (!other) {
      c.only_first.push_back(channel.header());
      continue;
    }
    Channel at_rows{channel.name, channel.unit, values_at(second, *other, first.time_s)};
    c.channels.push_back(difference(first.time_s, channel, at_rows.values));
    std::optional<double>& within = c.channels.back().within_band;
    within = share_in_band(c.first_band, channel.name, at_rows.values);
    if (!within) within = share_in_band(c.second_band, channel.name, channel.values);
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
