#pragma once
// Rows of a long table, kept as they come in, in a folder that survives an interruption. Several processes may work on the same
// table at once, on one machine or several, each in a file of its own; rows of all of them are found again.
//
// Every file begins with `# rows of <content>` and the header of the table; a row begins with its number, and behind it stands, after a tab, its hash.
// Files of another content are stale and never read. A line without its end, which a killed process leaves, does not count, nor does
// a row that is not as it was written.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace driftwright::output {

/// Rows by their number, each without its line break.
using NumberedRows = std::map<std::size_t, std::string>;

/// What makes rows belong together.
struct RowsIdentity {
  std::string content;  ///< one word that changes with all that decides the rows
  std::string header;   ///< of the table
};

/// All rows of that identity in the files `sweep*.csv` and `pieces*.csv`, whole or `.partial`, of a folder; none when it does not exist.
/// @param n_damaged  where given: how many lines were left out because they are not as they were written
[[nodiscard]] NumberedRows find_rows(const std::filesystem::path& folder, const RowsIdentity& identity,
                                     std::size_t* n_damaged = nullptr);

/// Removes those files, but not one that a process is writing to, and the folder when it is then empty. Never throws: rows that
/// stay do no harm.
void remove_rows(const std::filesystem::path& folder);

/// The file `<name>.partial` that this process adds rows to, until finish() makes it the file `<name>`.
class RowsUnderWay {
 public:
  /// Opens or creates it, drops what is stale in it, and locks it.
  /// @param name  "sweep.csv" or "pieces.csv", "sweep.3of8.csv" of a part
  /// @throws InputError  when another process works on it, or it cannot be written
  RowsUnderWay(const std::filesystem::path& folder, const std::string& name, RowsIdentity identity);
  ~RowsUnderWay();
  RowsUnderWay(const RowsUnderWay&) = delete;
  RowsUnderWay& operator=(const RowsUnderWay&) = delete;

  /// True when rows of another content were dropped.
  [[nodiscard]] bool dropped_stale() const { return dropped_stale_; }

  /// Adds a row; it is with the system when this returns. One thread at a time.
  /// @throws InputError  when it cannot be written
  void append(const std::string& row);

  /// Writes these rows, in the order of their numbers, to the file `<name>`, which appears whole; the partial one goes.
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
