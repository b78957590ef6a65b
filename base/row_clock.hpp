#pragma once
// The time of each row of a logger's file, and its cells with words for those that are not there.

#include <chrono>
#include <optional>

#include "base/delimited_text.hpp"
#include "base/logger_header.hpp"
#include "base/time_stamps.hpp"

namespace driftwright {

class RowClock {
 public:
  RowClock(const std::string& path, const ColumnMap& map, const LoggerHeader& header);

  /// Of the row that comes behind `n_rows` others [s]: stamps count from the first. @throws InputError
  [[nodiscard]] double time_s(const std::vector<Cell>& cells, int line, std::size_t n_rows);
  /// Where it stands.
  [[nodiscard]] Where place(const std::vector<Cell>& cells, int line) const;
  /// False where stamps might be of a clock that is set twice a year and nobody has said so.
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

/// Where cell `i` of a line stands.
[[nodiscard]] Where place_of(const std::string& path, const std::vector<Cell>& cells, std::size_t i, int line,
                             const std::string& key);
/// @throws InputError  where a row is too short
[[nodiscard]] const Cell& cell_of(const std::string& path, const std::vector<Cell>& cells, std::size_t i, int line,
                                  const std::string& key);
/// It stands for a reading that does not exist.
[[nodiscard]] bool is_missing(const ColumnMap& map, const std::string& text);

}  // namespace driftwright
