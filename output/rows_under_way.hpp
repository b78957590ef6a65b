#pragma once
// Stores the rows of a long table as they are computed, in a folder that survives an interruption. Several processes may
// work on the same table at once, on one machine or several, each with its own file; the rows of all of them are found
// again.
//
// Every file begins with `# rows of <content>` and the header of the table. A row begins with its number; its hash
// follows after a tab. Files with another content are stale and never read. An incomplete last line, which a killed
// process leaves, is ignored, and so is a row that does not match its hash.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace driftwright::output {

/// Rows by their number, each without its line break.
using NumberedRows = std::map<std::size_t, std::string>;

/// What rows must have in common to belong together.
struct RowsIdentity {
  std::string content;  ///< one word that changes with everything that determines the rows
  std::string header;   ///< of the table
};

/// All rows of that identity in the files `sweep*.csv` and `pieces*.csv`, whole or `.partial`, of a folder; none if it
/// does not exist.
/// @param n_damaged  unless null, receives the number of lines that were left out because they are damaged
[[nodiscard]] NumberedRows find_rows(const std::filesystem::path& folder, const RowsIdentity& identity,
                                     std::size_t* n_damaged = nullptr);

/// Removes those files, except one that a process is writing to, and then the folder if it is empty. Never throws:
/// remaining rows do no harm.
void remove_rows(const std::filesystem::path& folder);

/// The file `<name>.partial` that this process adds rows to, until finish() makes it the file `<name>`.
class RowsUnderWay {
 public:
  /// Opens or creates the file, drops stale content, and locks it.
  /// @param name  "sweep.csv" or "pieces.csv"; "sweep.3of8.csv" for a shard
  /// @throws InputError  when another process works on it, or it cannot be written
  RowsUnderWay(const std::filesystem::path& folder, const std::string& name, RowsIdentity identity);
  ~RowsUnderWay();
  RowsUnderWay(const RowsUnderWay&) = delete;
  RowsUnderWay& operator=(const RowsUnderWay&) = delete;

  /// True when rows of another content were dropped.
  [[nodiscard]] bool dropped_stale() const { return dropped_stale_; }

  /// Adds a row and passes it to the operating system. One thread at a time.
  /// @throws InputError  when it cannot be written
  void append(const std::string& row);

  /// Writes these rows, in the order of their numbers, to the file `<name>`, which appears complete; the partial file is
  /// removed.
  /// @throws InputError  when it cannot be written
  void finish(const NumberedRows& rows);

 private:
  void write_line(const std::string& line);

  std::filesystem::path file_;  // without ".partial"
  std::filesystem::path partial_;
  RowsIdentity identity_;
  int handle_ = -1;
  bool dropped_stale_ = false;
};

}  // namespace driftwright::output
