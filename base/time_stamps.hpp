#pragma once
// Converts time stamps of loggers into a continuous time, across clock changes and midnight.

#include <chrono>
#include <optional>
#include <string>

namespace driftwright {

/// An offset to UTC after a time of day, with or without a blank before it: +01:00, +0100, +01, Z, UTC, GMT, and European
/// zones by name (CET, CEST, MEZ, MESZ, WET, WEST, EET, EEST).
struct StampOffset {
  std::string stamp;  ///< without the offset
  std::chrono::minutes offset;
};
[[nodiscard]] std::optional<StampOffset> offset_at_end(const std::string& stamp);

/// The duration in a column of milliseconds beside a stamp. @throws RangeError  for NaN and for more than eleven days
[[nodiscard]] std::chrono::nanoseconds milliseconds(double count);

/// Reads the stamps of a file one after another.
///
/// Seconds may have a fraction after a point, a comma or a colon ("08:07:12:237"). In a zone, one hour occurs twice a year;
/// the order of the stamps decides: the earlier one, unless it does not follow the previous stamp. If the format has no
/// date, a time more than 12 h earlier than the previous one is on the next day. Source: Hinnant, date and tz libraries (the
/// C++20 calendar), with the system's IANA data base.
class TimeStamps {
 public:
  /// @param format  as for strftime(): %d.%m.%Y %H:%M:%S, at its end perhaps %z for an offset as offset_at_end() knows it;
  ///                empty: ISO 8601
  /// @param zone    IANA time zone; empty: all stamps are from one clock without clock changes
  /// @throws RangeError  for an unknown zone, and for a zone together with a format without a date
  TimeStamps(std::string format, const std::string& zone);

  /// Time since an epoch that is the same for all stamps.
  /// @throws RangeError  for a text that does not match the format, for a time that a clock in the zone skips, and for years
  /// before 1700 or after 2200, which come from clocks that were never set
  [[nodiscard]] std::chrono::nanoseconds read(const std::string& text);

  [[nodiscard]] bool has_date() const { return has_date_; }
  [[nodiscard]] bool has_zone() const { return zone_ != nullptr; }

 private:
  [[nodiscard]] std::chrono::nanoseconds in_zone(std::chrono::nanoseconds local, const std::string& text) const;

  std::string format_;
  const void* zone_ = nullptr;  // date::time_zone, owned by the library for the life of the program
  bool is_iso_ = true, has_date_ = true;
  bool has_offset_ = false;  ///< the format had %z at its end; format_ is without it
  std::optional<std::chrono::nanoseconds> before_;
};

}  // namespace driftwright
