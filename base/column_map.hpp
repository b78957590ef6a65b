#pragma once
// How the file of a logger is written: which of its columns are the channels of a record, in which unit, and how it tells the time.

#include <optional>
#include <string>
#include <vector>

#include "base/errors.hpp"

namespace driftwright {

/// A column of a file, by the name in its header or by its place.
struct ColumnPlace {
  std::string name;  ///< as the header has it; empty: by position
  int position = 0;  ///< from 1; 0: by name
  Where where;       ///< in the scenario

  /// "'T3 (°C)'" or "column 4".
  [[nodiscard]] std::string words() const;
};

/// How the time of a row is told: by a time stamp, by a number in `unit`, or by counting rows.
struct TimeColumns {
  std::vector<ColumnPlace> columns;         ///< their cells, joined by blanks, are the time; empty: rows are counted
  std::optional<ColumnPlace> milliseconds;  ///< a column of its own that is added to the stamp
  std::string format;                       ///< of stamps, as strftime() has it; empty without `unit`: ISO 8601
  std::string unit;                         ///< of numbers; empty: stamps
  std::string zone;         ///< of the IANA data base, such as "Europe/Berlin"; empty: a clock that is never set
  double interval_s = 0.0;  ///< from row to row, where they are counted

  [[nodiscard]] bool has_stamps() const { return interval_s == 0.0 && unit.empty(); }
};

/// A channel of a record: factor x (number in the file) + offset, in `written_unit`, converted to `unit`.
struct MappedChannel {
  std::string name;
  std::string unit;  ///< of known_units()
  ColumnPlace column;
  std::string written_unit;  ///< of the file, as UDUNITS reads it
  double factor = 1.0;       ///< not 0
  double offset = 0.0;       ///< in written_unit
  bool magnitude = false;    ///< the sign does not count

  [[nodiscard]] double value(double number) const;  ///< in `unit`
};

/// Where a row is one tag's value at one time, as controls log what has changed: a value holds until the next of its tag. The columns of the channels are then
/// names of tags.
struct TagColumns {
  ColumnPlace tag, value;
  double every_s = 0.0;  ///< rows of the record are so far apart; 0: there is one at each time of the log
};

struct ColumnMap {
  enum class Header { kFound, kAtLine, kNone };
  char separator = '\0';  ///< of cells; ' ': any number of blanks; 0: found from the header
  char decimal = '.';     ///< or ','
  Header header = Header::kFound;
  int header_line = 0;               ///< from 1, for kAtLine
  std::string end;                   ///< the first line that begins with it ends the rows; empty: the file's end does
  std::vector<std::string> missing;  ///< cells that stand for a missing reading, beside empty ones
  TimeColumns time;
  std::optional<TagColumns> tags;
  std::vector<MappedChannel> channels;
  Where where;
};

/// The unit in which a record carries what a file has in `written_unit` (UDUNITS syntax): degC for absolute temperatures, K for
/// differences, um for lengths, mm_min for velocities, rpm, urad, W, W_m2, V, percent, count, s, 1.
/// @throws RangeError  for an unknown unit, and for one that records have no room for
[[nodiscard]] std::string record_unit(const std::string& written_unit);

/// The unit of a record's header as UDUNITS reads it: "mm/min" of "mm_min", "%" of "percent".
[[nodiscard]] std::string in_udunits(const std::string& record_unit);

/// What the map says, a line each, for people.
[[nodiscard]] std::vector<std::string> words(const ColumnMap& columns);

}  // namespace driftwright
