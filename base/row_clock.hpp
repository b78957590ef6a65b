#pragma once
// The time of each row of a logger's file, and access to its cells with clear errors for missing ones.

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

  /// Time of the row that follows `n_rows` others [s]; stamps count from the first row. @throws InputError
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
};

/// The position of cell `i` of a line.
[[nodiscard]] Where place_of(const std::string& path, const std::vector<Cell>& cells, std::size_t i, int line,
                             const std::string& key);
/// @throws InputError  where a row is too short
[[nodiscard]] const Cell& cell_of(const std::string& path, const std::vector<Cell>& cells, std::size_t i, int line,
                                  const std::string& key);
/// True if the cell's text means a missing reading.
[[nodiscard]] bool is_missing(const ColumnMap& map, const std::string& text);

}  // namespace driftwright
