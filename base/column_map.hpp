#pragma once
// Describes the layout of a logger's file: which of its columns are the channels of a record, in which unit, and how it
// gives the time.

#include <optional>
#include <string>
#include <vector>

#include "base/errors.hpp"

namespace driftwright {

/// A column of a file, given by the name in its header or by its position.
struct ColumnPlace {
  std::string name;  ///< as in the header; empty: by position
  int position = 0;  ///< from 1; 0: by name
  Where where;       ///< in the scenario

  /// "'T3 (°C)'" or "column 4".
  [[nodiscard]] std::string words() const;
};

/// How a row gives its time: by a time stamp, by a number in `unit`, or by its count.
struct TimeColumns {
  std::vector<ColumnPlace> columns;         ///< their cells, joined by blanks, are the time; empty: rows are counted
  std::optional<ColumnPlace> milliseconds;  ///< a separate column that is added to the stamp
  std::string format;                       ///< of stamps, as strftime() has it; empty without `unit`: ISO 8601
  std::string unit;                         ///< of numbers; empty: stamps
  std::string zone;         ///< IANA time zone, such as "Europe/Berlin"; empty: a clock without clock changes
  double interval_s = 0.0;  ///< from row to row, where rows are counted

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
  bool magnitude = false;    ///< only the absolute value is used

  [[nodiscard]] double value(double number) const;  ///< in `unit`
};

/// For files in which each row gives the value of one tag at one time, as controls log changes: a value applies until the
/// next one of its tag. The columns of the channels are then names of tags.
struct TagColumns {
  ColumnPlace tag, value;
  double every_s = 0.0;  ///< interval of the record's rows; 0: one row at each time of the log
};

/// The whole description; the key `columns` of a scenario.
struct ColumnMap {
  enum class Header { kFound, kAtLine, kNone };
  char separator = '\0';  ///< of cells; ' ': any number of blanks; 0: found from the header
  char decimal = '.';     ///< or ','
  Header header = Header::kFound;
  int header_line = 0;  ///< from 1, for kAtLine
  std::string end;      ///< a line that begins with this text ends the rows; empty: rows go on to the file's end
  std::vector<std::string> missing;  ///< texts that mean a missing reading, besides empty cells
  TimeColumns time;
  std::optional<TagColumns> tags;
  std::vector<MappedChannel> channels;
  Where where;
};

/// The unit in which a record stores a column written in `written_unit` (UDUNITS syntax): degC for absolute temperatures, K
/// for differences, um for lengths, mm_min for velocities, rpm, urad, W, W_m2, V, percent, count, s, 1.
/// @throws RangeError  for an unknown unit, for a unit that records cannot store, and for one that is too large for any
///                     instrument of a machine, such as furlong
[[nodiscard]] std::string record_unit(const std::string& written_unit);

/// The unit of a record's header as UDUNITS reads it: "mm/min" of "mm_min", "%" of "percent".
[[nodiscard]] std::string in_udunits(const std::string& record_unit);

/// What the map says, a line each, for people.
[[nodiscard]] std::vector<std::string> words(const ColumnMap& columns);

}  // namespace driftwright
