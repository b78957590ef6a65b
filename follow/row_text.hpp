#pragma once
// Rows of a stream as text, line by line: CSV with a header as records have it, a logger's CSV by a map of its columns, or JSON objects.

#include <memory>
#include <optional>
#include <string>

#include "base/column_map.hpp"
#include "follow/stream_row.hpp"

namespace driftwright::follow {

/// Reads lines one after another. The first line that is no comment decides: one that begins with `{` is JSON, whose keys are named as the columns
/// of a record ("time_s", "speed_rpm"; null: missing), or as the map names them; any other is a header of CSV, unless the map says there is none.
class RowText {
 public:
  /// @param columns  none: headers are those of records (docs/reference/record.md): "time_s,speed_rpm,t01_degC"
  /// @param source   where the lines come from, for messages
  RowText(std::optional<ColumnMap> columns, std::string source);
  ~RowText();

  /// Takes a line without its line break. @return the row; none for the header, comments, empty lines, and the header said again
  /// @throws InputError  for a header that cannot be read, which no later line mends
  /// @throws RangeError  for a row that is none, saying why; the next one may be well
  std::optional<StreamRow> take(const std::string& line);

  /// Of the stream, without values; empty before its header or first row was there.
  [[nodiscard]] const std::vector<Channel>& channels() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The text of a number: as record CSVs have it, "" and any writing of NaN for a missing one. @throws RangeError  for other words
[[nodiscard]] double stream_number(const std::string& text, char decimal);

}  // namespace driftwright::follow
