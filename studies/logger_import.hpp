#pragma once
// Reads a logger's file as a record, with a given or a guessed map of its columns.

#include <optional>
#include <string>
#include <vector>

#include "base/guess_columns.hpp"
#include "base/mapped_record.hpp"

namespace driftwright::studies {

struct LoggerImport {
  ColumnMap map;
  std::vector<std::string> without_unit;  ///< as GuessedColumns
  std::string read_by;                    ///< file with the map; empty: the map was guessed
  std::vector<std::string> guesses;       ///< assumptions about what the file does not say
  ReadRecord read;
};

/// Units of columns, from "t1=degC". @throws InputError  for a text without a column or a unit
[[nodiscard]] std::map<std::string, std::string> units_of_columns(const std::vector<std::string>& said);

/// @param by  YAML with the key `columns`: a scenario, or a file that an import has written; empty: the map is guessed
/// @throws InputError  as read_columns(), guess_columns() and read_record()
[[nodiscard]] LoggerImport import_logger(const std::string& path, const std::string& by, const GuessHints& hints);

}  // namespace driftwright::studies
