#pragma once
// Reads rows of a stream from text, line by line: CSV with the header of a record, a logger's CSV with a map of its
// columns, or JSON objects.

#include <memory>
#include <optional>
#include <string>

#include "base/column_map.hpp"
#include "follow/stream_row.hpp"

namespace driftwright::follow {

/// The first line that is no comment decides the format: a line that begins with `{` is JSON, with keys named as the
/// columns of a record ("time_s", "speed_rpm"; null: missing) or as in the map; any other line is a CSV header, unless
/// the map says that there is none.
class RowText {
 public:
  /// @param columns  none: headers are those of records (docs/reference/record.md): "time_s,speed_rpm,t01_degC"
  /// @param source   where the lines come from, for messages
  RowText(std::optional<ColumnMap> columns, std::string source);
  ~RowText();

  /// Takes a line without its line break.
  /// @return the row; none for the header, comments, empty lines, and a repeated header
  /// @throws InputError  for a header that cannot be read, which no later line repairs
  /// @throws RangeError  for a line that is no row, with the reason; the next one may be valid
  std::optional<StreamRow> take(const std::string& line);

  /// The channels of the stream, without values; empty before its header or first row.
  [[nodiscard]] const std::vector<Channel>& channels() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What the numbers in each column are, by the headers of records or by the map. A column that nobody reads has no unit.
/// @param headers  of all columns, the time's first
[[nodiscard]] std::vector<ColumnUnit> column_units(const std::vector<std::string>& headers,
                                                   const std::optional<ColumnMap>& columns);

/// The text of a number: as record CSVs have it, "" and any writing of NaN for a missing one. @throws RangeError  for other
/// words
[[nodiscard]] double stream_number(const std::string& text, char decimal);

}  // namespace driftwright::follow
