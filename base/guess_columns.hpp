#pragma once
// A map of a logger's file that nobody has described yet, guessed from the file.

#include <string>
#include <vector>

#include "base/column_map.hpp"

namespace driftwright {

struct GuessedColumns {
  ColumnMap map;
  std::vector<std::string> guesses;  ///< sentences: what the file does not say and was taken so
};

/// What the user says of the file, each "" where he says nothing.
struct GuessHints {
  std::string zone;      ///< of stamps
  std::string interval;  ///< from row to row, such as "10 s", where no column tells the time
  std::string every;     ///< from row to row of the record, of a log of tags
};

/// Finds separator, header, decimal sign, the columns of the time and their format, units in headers such as "T3 (°C)" or in a line below the header, words for
/// missing readings, and logs with a tag in each row. Columns of numbers become channels; a spindle speed is called `speed`, the temperature of the
/// ambient `ambient`.
/// @throws InputError  where no rows, no time or no channel can be made out, saying what to write into `columns`
[[nodiscard]] GuessedColumns guess_columns(const std::string& path, const GuessHints& hints);

/// The map as YAML, as the key `columns` of a scenario holds it.
[[nodiscard]] std::string yaml_text(const ColumnMap& map);

}  // namespace driftwright
