#pragma once
// A logger's file as a record, by a map that is given or guessed.

#include <optional>
#include <string>
#include <vector>

#include "base/guess_columns.hpp"
#include "base/mapped_record.hpp"

namespace driftwright::studies {

struct LoggerImport {
  ColumnMap map;
  std::string read_by;               ///< the file that says the map; empty: it was guessed
  std::vector<std::string> guesses;  ///< what the file does not say
  ReadRecord read;
};

/// @param by  YAML with the key `columns`: a scenario, or what an import has written; empty: the map is guessed
/// @throws InputError  as read_columns(), guess_columns() and read_record()
[[nodiscard]] LoggerImport import_logger(const std::string& path, const std::string& by, const GuessHints& hints);

}  // namespace driftwright::studies
