#include "base/time_stamps.hpp"

#include <date/date.h>
#include <date/tz.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

#include "base/characters.hpp"
#include "base/errors.hpp"
#include "base/pattern.hpp"

namespace driftwright {
namespace {

using std::chrono::nanoseconds;
constexpr nanoseconds kDay = std::chrono::hours(24), kHalfDay = std::chrono::hours(12);

bool has_any(const std::string& format, const std::string& letters) {
  for (std::size_t i = 0; i + 1 < format.size(); ++i) {
    if (format[i] == '%' && letters.find(format[++i]) != std::string::npos) return true;
  }
  return false;
}

/// "08:07:12:237" and "08:07:12,237" as "08:07:12.237".
std::string with_point(std::string text) {
  for (std::size_t i = 0; i + 9 < text.size(); ++i) {
    const auto digits = [&](std::size_t at) { return is_digit(text[at]) && is_digit(text[at + 1]); };
    const bool is_time = digits(i) && text[i + 2] == ':' && digits(i + 3) && text[i + 5] == ':' && digits(i + 6);
    if (!is_time) continue;
    if ((text[i + 8] == ':' || text[i + 8] == ',') && is_digit(text[i + 9])) text[i + 8] = '.';
    break;
  }
  return text;
}

template <class Time>
bool fits(const std::string& text, const std::string& format, Time& time) {
  std::istringstream in(text);
  in >> date::parse(format, time);
  return !in.fail() && (in >> std::ws).eof();
}

/// Time since 1970 of a stamp with its date. Nanoseconds in 64 bits reach from 1677 to 2262; clocks that were never set show
/// the year 1 or 9999.
std::optional<nanoseconds> dated(const std::string& stamp, const std::string& format) {
  std::istringstream in(stamp);
  date::fields<nanoseconds> told;
  told.has_tod = true;
  date::from_stream(in, format.c_str(), told);
  if (in.fail() || !(in >> std::ws).eof() || !told.ymd.ok() || !told.tod.in_conventional_range()) return std::nullopt;
  const int year = static_cast<int>(told.ymd.year());
  if (year < 1700 || year > 2200)
    throw RangeError(fmt::format("'{}' is of the year {}; 1700 to 2200 are allowed", stamp, year));
  return date::sys_days(told.ymd).time_since_epoch() + told.tod.to_duration();
}

/// A stamp of ISO 8601 without its offset: date, T or a blank, time.
std::optional<nanoseconds> iso_8601(std::string text) {
  if (text.size() > 10 && text[10] == ' ') text[10] = 'T';
  for (const char* format : {"%FT%T", "%FT%H:%M", "%F"}) {
    if (const auto time = dated(text, format)) return time;
  }
  return std::nullopt;
}

}  // namespace

std::optional<StampOffset> offset_at_end(const std::string& stamp) {
  static const Pattern number("^(.*[0-9])[ \t]*([-+])([0-9]{2}):?([0-9]{2})?$"), word("^(.*[0-9])[ \t]*([A-Z]{1,4})$");
  static const std::map<std::string, int> hours = {{"Z", 0},    {"UTC", 0}, {"GMT", 0},  {"WET", 0}, {"WEST", 1}, {"CET", 1},
                                                   {"CEST", 2}, {"MEZ", 1}, {"MESZ", 2}, {"EET", 2}, {"EEST", 3}};
  constexpr std::size_t kLongest = 64;  // stamps are shorter
  if (stamp.size() > kLongest) return std::nullopt;
  if (const auto parts = number.find(stamp)) {
    const int minutes = 60 * std::stoi(parts->at(3)) + (parts->at(4).empty() ? 0 : std::stoi(parts->at(4)));
    return StampOffset{parts->at(1), std::chrono::minutes(parts->at(2) == "-" ? -minutes : minutes)};
  }
  const auto parts = word.find(stamp);
  const auto known = parts ? hours.find(parts->at(2)) : hours.end();
  if (known == hours.end()) return std::nullopt;
  return StampOffset{parts->at(1), std::chrono::hours(known->second)};
}

TimeStamps::TimeStamps(std::string format, const std::string& zone) : format_(std::move(format)) {
  is_iso_ = format_.empty();
  has_date_ = is_iso_ || has_any(format_, "dejDFcxmsUW");
  static const Pattern offset("[ \t]*%E?z$");
  if (const auto end = offset.find(format_)) {
    has_offset_ = true;
    format_.resize(format_.size() - end->front().size());
  }
  if (has_any(format_, "z") || format_.find("%Ez") != std::string::npos)
    throw RangeError("%z, the offset to UTC, is allowed only at the end of a format");
  if (zone.empty()) return;
  if (!has_date_) throw RangeError("a zone requires stamps with a date, but this format has none");
  try {
    zone_ = date::locate_zone(zone);
  } catch (const std::runtime_error&) {
    throw RangeError(fmt::format("'{}' is no time zone of the IANA data base, such as Europe/Berlin or UTC", zone));
  }
}

nanoseconds TimeStamps::read(const std::string& text) {
  std::string stamp = with_point(text);
  nanoseconds time{}, offset{};
  std::optional<StampOffset> told = has_offset_ || is_iso_ ? offset_at_end(stamp) : std::nullopt;
  if (is_iso_ && told && told->stamp.find(':') == std::string::npos) told.reset();  // 2024-03-01: a date
  if (has_offset_ && !told)
    throw RangeError(fmt::format(
        "'{}' has no offset to UTC at its end, which %z requires: such as +01:00, +0100, +01, Z, UTC or CET", text));
  if (told) {
    stamp = told->stamp;
    offset = told->offset;
  }
  if (is_iso_) {
    const auto iso = iso_8601(stamp);
    if (!iso)
      throw RangeError(
          fmt::format("'{}' is no time stamp of ISO 8601 (2024-03-01T10:00:00); `format` says how others are written, "
                      "`unit` that it is a number",
                      text));
    time = *iso;
  } else if (has_date_) {
    const auto point = dated(stamp, format_);
    if (!point)
      throw RangeError(
          fmt::format("'{}' is no time stamp of the format '{}'", text, has_offset_ ? format_ + "%z" : format_));
    time = *point;
  } else {
    if (!fits(stamp, format_, time))
      throw RangeError(fmt::format("'{}' is no time of the format '{}'", text, has_offset_ ? format_ + "%z" : format_));
    if (before_) {
      time += *before_ - *before_ % kDay;
      if (*before_ - time > kHalfDay) time += kDay;
    }
  }
  if (zone_ && !told) time = in_zone(time, text);
  time -= offset;
  before_ = time;
  return time;
}

nanoseconds milliseconds(double count) {
  constexpr double kMost = 1e9;  // eleven days; 64 bits of nanoseconds hold far more
  if (!(std::abs(count) <= kMost))
    throw RangeError(fmt::format("{:g} is no number of milliseconds; at most {:g} are allowed", count, kMost));
  return nanoseconds(std::llround(1e6 * count));
}

nanoseconds TimeStamps::in_zone(nanoseconds local, const std::string& text) const {
  const auto& zone = *static_cast<const date::time_zone*>(zone_);
  const auto info = zone.get_info(date::local_time<nanoseconds>(local));
  const nanoseconds first = local - info.first.offset;
  if (info.result == date::local_info::unique) return first;
  if (info.result == date::local_info::nonexistent)
    throw RangeError(fmt::format("'{}' does not exist in {}: clocks skip that hour", text, zone.name()));
  return before_ && first <= *before_ ? local - info.second.offset : first;
}

}  // namespace driftwright
