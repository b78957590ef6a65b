#pragma once
// Reads records from files of loggers, by a map of their columns.

#include <optional>
#include <string>
#include <vector>

#include "base/column_map.hpp"
#include "base/record.hpp"

namespace driftwright {

/// A record, and remarks on how it was read.
struct ReadRecord {
  Record record;
  std::vector<std::string>
      notes;  ///< sentences: columns that are not named, lines that were passed over, a clock that seems to have been set
  std::size_t n_without_reading =
      0;  ///< rows of a logger's file in which no channel has a reading, which are no rows of the record
};

/// Reads a record: without `columns` as read_record_csv() does, else a file of a logger. Its time counts from the first row
/// where it is told by stamps or by a clock's number, such as seconds since 1970, and from 0 where rows are counted. A
/// logger's row in which no channel has a reading is no row, such as one that marks the end of the file: neither its time
/// nor what else it has counts, but where rows are counted the time goes on by it. In a record CSV it is one, since its time
/// may be meant: the last row of a plan ends it.
/// @throws InputError  file, line and column, for what read_record_csv() refuses, a header that lacks a named column (with
///                     the columns there are), cells that are no number, thousands separators, stamps that the format does
///                     not fit or that do not increase
[[nodiscard]] ReadRecord read_record(const std::string& path, const std::optional<ColumnMap>& columns);

}  // namespace driftwright
