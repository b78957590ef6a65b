#pragma once
// Time stamps as loggers write them, turned into time that only goes on: across clock changes and midnight.

#include <chrono>
#include <optional>
#include <string>

namespace driftwright {

/// An offset to UTC behind a time of day, with or without a blank before it: +01:00, +0100, +01, Z, UTC, GMT, and European clocks by their names (CET, CEST, MEZ,
/// MESZ, WET, WEST, EET, EEST).
struct StampOffset {
  std::string stamp;  ///< without it
  std::chrono::minutes offset;
};
[[nodiscard]] std::optional<StampOffset> offset_at_end(const std::string& stamp);

/// A column of milliseconds beside a stamp. @throws RangeError  for NaN and for more than eleven days
[[nodiscard]] std::chrono::nanoseconds milliseconds(double count);

/// Reads the stamps of a file one after another.
///
/// Seconds may have a fraction behind a point, a comma or a colon ("08:07:12:237"). In a zone, an hour that comes twice a year is told by the order
/// of the stamps: the earlier one unless it does not follow the stamp before. Where the format has no date, a time more than 12 h earlier
/// than the one before is of the next day. Source: Hinnant, date and tz libraries (the C++20 calendar), with the IANA data base of the system.
class TimeStamps {
 public:
  /// @param format  as strftime() has it: %d.%m.%Y %H:%M:%S, at its end perhaps %z for an offset as offset_at_end() knows it; empty: ISO 8601
  /// @param zone    of the IANA data base; empty: all stamps are of one clock that is never set
  /// @throws RangeError  for a zone that is not known, and for a zone beside a format without a date
  TimeStamps(std::string format, const std::string& zone);

  /// Time since an epoch that is the same for all stamps.
  /// @throws RangeError  for a text that the format does not fit, for a time that a clock in the zone skips, and for years before 1700 or
  /// after 2200, which clocks tell that were never set
  [[nodiscard]] std::chrono::nanoseconds read(const std::string& text);

  [[nodiscard]] bool has_date() const { return has_date_; }
  [[nodiscard]] bool has_zone() const { return zone_ != nullptr; }

 private:
  [[nodiscard]] std::chrono::nanoseconds in_zone(std::chrono::nanoseconds local, const std::string& text) const;

  std::string format_;
  const void* zone_ = nullptr;  // date::time_zone, owned by the library for the life of the program
  bool is_iso_ = true, has_date_ = true;
  bool has_offset_ = false;  ///< the format had %z at its end, which is no more in format_
  std::optional<std::chrono::nanoseconds> before_;
};

}  // namespace driftwright
