#pragma once
// A logger's file of which nothing is known yet, as cells: rows that look alike, and what stands over them.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace driftwright {

struct LoggerSheet {
  using Row = std::vector<std::string>;
  char separator = '\0';
  char decimal = '.';
  std::size_t header_line = 0;  ///< index
  Row names;                    ///< of columns
  Row units;                    ///< of a line of units between names and rows; empty where there is none
  std::string end;              ///< the line that ends the rows; "": the file's end does
  std::vector<Row> rows;        ///< as wide as `names` at least; the first 5000

  /// The cells of a column, of the rows that have it.
  [[nodiscard]] std::vector<std::string> column(std::size_t index) const;
};

/// @throws InputError  where no rows, or no names above them, can be made out
[[nodiscard]] LoggerSheet logger_sheet(const std::string& path, const std::vector<std::string>& lines);

/// A cell as a number; nothing where it is none.
[[nodiscard]] std::optional<double> number_of(const std::string& cell, char decimal);
/// Of the cells that hold anything, 0 to 1.
[[nodiscard]] double share_of_numbers(const std::vector<std::string>& cells, char decimal);
/// Digits as dates and times of day have them.
[[nodiscard]] bool is_stamp_like(const std::string& cell);

}  // namespace driftwright
