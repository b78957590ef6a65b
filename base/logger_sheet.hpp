#pragma once
// The cells of a logger's file without a description: rows that look alike, and the lines above them.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace driftwright {

/// Header and rows of such a file.
struct LoggerSheet {
  using Row = std::vector<std::string>;
  char separator = '\0';
  char decimal = '.';
  std::size_t header_line = 0;  ///< index
  Row names;                    ///< of columns
  Row units;                    ///< of a line of units between names and rows; empty where there is none
  std::string end;              ///< the line that ends the rows; "": they go on to the file's end
  std::vector<Row> rows;        ///< at least as wide as `names`; the first 5000

  /// The cells of one column; rows that are too short are left out.
  [[nodiscard]] std::vector<std::string> column(std::size_t index) const;
};

/// @throws InputError  where no rows, or no names above them, are found
[[nodiscard]] LoggerSheet logger_sheet(const std::string& path, const std::vector<std::string>& lines);

/// The number in a cell; none if it is not a number.
[[nodiscard]] std::optional<double> number_of(const std::string& cell, char decimal);
/// Share of numbers among the non-empty cells, 0 to 1.
[[nodiscard]] double share_of_numbers(const std::vector<std::string>& cells, char decimal);
/// True if all non-empty cells, at least one, are words of switches (switch_of()).
[[nodiscard]] bool are_switches(const std::vector<std::string>& cells);
/// Of a column of a switch, that is one in which more than half of the cells with text are its words: the first cell with
/// another text. None if there is no such cell, or the column is not a switch.
[[nodiscard]] std::optional<std::string> odd_among_switches(const std::vector<std::string>& cells);
/// True if the digits look like a date or a time of day.
[[nodiscard]] bool is_stamp_like(const std::string& cell);

}  // namespace driftwright
