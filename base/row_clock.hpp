#pragma once
// The time of each row of a logger's file, and access to its cells with clear errors for missing ones, and their numbers.

#include <chrono>
#include <optional>

#include "base/delimited_text.hpp"
#include "base/logger_header.hpp"
#include "base/time_stamps.hpp"

namespace driftwright {

/// Reads the time of the rows, one after another.
class RowClock {
 public:
  RowClock(const std::string& path, const ColumnMap& map, const LoggerHeader& header);

  /// Time of the row that follows `n_rows` others [s]. Stamps count from the first row, and so do numbers of a clock, such
  /// as seconds since 1970, of which a record would not hold the fractions. @throws InputError
  [[nodiscard]] double time_s(const std::vector<Cell>& cells, int line, std::size_t n_rows);
  /// The position of the time cell, for messages.
  [[nodiscard]] Where place(const std::vector<Cell>& cells, int line) const;
  /// False if stamps might be from a clock with summer time and the map does not say so.
  [[nodiscard]] bool knows_clock_changes() const;

 private:
  std::string path_;
  const ColumnMap& map_;
  TimeStamps stamps_;
  std::vector<std::size_t> columns_;
  std::optional<std::size_t> milliseconds_;
  double seconds_ = 1.0;
  std::optional<std::chrono::nanoseconds> first_;
  std::optional<double> first_number_s_;
};

/// The position of cell `i` of a line.
[[nodiscard]] Where place_of(const std::string& path, const std::vector<Cell>& cells, std::size_t i, int line,
                             const std::string& key);
/// @throws InputError  where a row is too short
[[nodiscard]] const Cell& cell_of(const std::string& path, const std::vector<Cell>& cells, std::size_t i, int line,
                                  const std::string& key);
/// The number of a word for a switch: 1 for true, on, yes (wahr, ein, an, ja), 0 for their opposites, in any case; none for
/// any other text.
[[nodiscard]] std::optional<double> switch_of(const std::string& text);
/// The number in a cell of a channel; a plain number may be a word for a switch. @throws RangeError  as parse_number()
[[nodiscard]] double number_in(const std::string& text, const MappedChannel& channel, char decimal);
/// True if the cell's text means a missing reading.
[[nodiscard]] bool is_missing(const ColumnMap& map, const std::string& text);

}  // namespace driftwright
