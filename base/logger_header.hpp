#pragma once
// Finds the header of a logger's file and the columns that a map names.

#include <cstddef>
#include <string>
#include <vector>

#include "base/column_map.hpp"

namespace driftwright {

/// The header line of a file.
struct LoggerHeader {
  std::size_t line = 0;  ///< index of the header; rows begin after it, or at it without a header
  char separator = '\0';
  std::vector<std::string> names;  ///< of columns
};

/// The columns that a map names: first the time, then its channels or tags.
[[nodiscard]] std::vector<ColumnPlace> places_of(const ColumnMap& map);

/// Finds the line that contains the named columns; without a header, the first line that is not a comment.
/// @throws InputError  where a column is missing; the message lists the existing columns
[[nodiscard]] LoggerHeader find_header(const std::string& path, const std::vector<std::string>& lines, const ColumnMap& map);

/// Index of a column. @throws InputError  where two columns have its name
[[nodiscard]] std::size_t index_of(const std::string& path, const LoggerHeader& header, const ColumnPlace& place);

}  // namespace driftwright
