#pragma once
// Records from files of loggers, by a map of their columns.

#include <optional>
#include <string>
#include <vector>

#include "base/column_map.hpp"
#include "base/record.hpp"

namespace driftwright {

/// A record and what is worth knowing of how it was read.
struct ReadRecord {
  Record record;
  std::vector<std::string>
      notes;  ///< sentences: columns that are not named, lines that were passed over, a clock that seems to have been set
};

/// Reads a record: without `columns` as read_record_csv() does, else a file of a logger. Its time counts from the first row where it is told by
/// stamps, and from 0 where rows are counted.
/// @throws InputError  file, line and column, for what read_record_csv() refuses, a header that lacks a named column (with the columns there
///                     are), cells that are no number, thousands separators, stamps that the format does not fit or that do not increase
[[nodiscard]] ReadRecord read_record(const std::string& path, const std::optional<ColumnMap>& columns);

}  // namespace driftwright
