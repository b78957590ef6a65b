#pragma once
// Where the header of a logger's file is, and which of its columns a map names.

#include <cstddef>
#include <string>
#include <vector>

#include "base/column_map.hpp"

namespace driftwright {

struct LoggerHeader {
  std::size_t line = 0;  ///< index; rows begin behind it, or at it where there is no header
  char separator = '\0';
  std::vector<std::string> names;  ///< of columns
};

/// The columns that a map names: of the time, then of its channels or of tags.
[[nodiscard]] std::vector<ColumnPlace> places_of(const ColumnMap& map);

/// The line that has the named columns; without a header the first that is no comment.
/// @throws InputError  with the columns there are, where one is missing
[[nodiscard]] LoggerHeader find_header(const std::string& path, const std::vector<std::string>& lines, const ColumnMap& map);

/// @throws InputError  where two columns have the name
[[nodiscard]] std::size_t index_of(const std::string& path, const LoggerHeader& header, const ColumnPlace& place);

}  // namespace driftwright
