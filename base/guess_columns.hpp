#pragma once
// Guesses the column map of a logger's file that has no description yet.

#include <map>
#include <string>
#include <vector>

#include "base/column_map.hpp"

namespace driftwright {

/// A guessed map, and what the guess assumed.
struct GuessedColumns {
  ColumnMap map;
  std::vector<std::string> guesses;       ///< sentences: what the file does not say and the guess assumed
  std::vector<std::string> without_unit;  ///< headers of columns taken for plain numbers because nothing says a unit
};

/// What the user says about the file; "" for what the user does not say.
struct GuessHints {
  std::string zone;      ///< of stamps
  std::string interval;  ///< from row to row, such as "10 s", where no column contains the time
  std::string every;     ///< from row to row of the record, of a log of tags
  /// Units by column, either as in the header or by the channel's name; "none" leaves the column out.
  std::map<std::string, std::string> units = {};
};

/// Finds the separator, header, decimal sign, the time columns and their format, units in headers such as "T3 (°C)" or in a
/// line below the header, texts for missing readings, and logs with a tag in each row. Columns of numbers become channels,
/// and so do columns of switches (true and false, on and off), as plain numbers; a spindle speed is called `speed`, the
/// ambient temperature `ambient`.
/// @throws InputError  where no rows, no time or no channel are found; the message says what to write into `columns`; for a
///                     unit of a column that is not there, or that records cannot store
[[nodiscard]] GuessedColumns guess_columns(const std::string& path, const GuessHints& hints);

/// The map as YAML, as the key `columns` of a scenario holds it.
[[nodiscard]] std::string yaml_text(const ColumnMap& map);

}  // namespace driftwright
