#pragma once
// A record, or a part of it, as given on the command line: run.csv, or run.csv:20h..28h.

#include <limits>
#include <string>
#include <utility>

#include "base/record.hpp"

namespace driftwright::scenarios {

/// The rows from `from_s` to before `until_s`, times since the first row of the record.
struct RecordPart {
  std::string file;
  double from_s = 0.0;
  double until_s = std::numeric_limits<double>::infinity();
  std::string words;  ///< the text of the command line

  [[nodiscard]] bool is_whole() const { return from_s == 0.0 && until_s == std::numeric_limits<double>::infinity(); }
};

/// Reads "run.csv", "run.csv:0h..20h", "run.csv:90min..", "run.csv:..2h". If a file has exactly this name, that file is
/// meant.
/// @throws InputError  for times without a unit, or if `until` is not after `from`
[[nodiscard]] RecordPart read_record_part(const std::string& argument);

/// The first row of the part, and the row after its last.
/// @throws InputError  for a part that the record does not have, or one that holds fewer than three rows
[[nodiscard]] std::pair<std::size_t, std::size_t> rows_of(const RecordPart& part, const Record& record);

/// Whether two paths name the same file, however they are written.
[[nodiscard]] bool is_same_file(const std::string& a, const std::string& b);

/// Whether the part shares rows with those of `file` from first_s to last_s, times of rows since the first row of the
/// file.
[[nodiscard]] bool has_rows_of(const RecordPart& part, const std::string& file, double first_s, double last_s);

/// @throws InputError  if both parts share rows of one file
void refuse_overlap(const RecordPart& a, const RecordPart& b);

}  // namespace driftwright::scenarios
