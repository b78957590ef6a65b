#include "output/rows_under_way.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <optional>
#include <sstream>

#include "base/errors.hpp"
#include "base/file_bytes.hpp"
#include "output/results_folder.hpp"

namespace driftwright::output {
namespace {

namespace fs = std::filesystem;

std::string opening(const RowsIdentity& identity) {
  return fmt::format("# rows of {}\n{}\n", identity.content, identity.header);
}

bool is_rows_file(const fs::path& path) {
  const std::string name = path.filename().string();
  return (name.starts_with("sweep") || name.starts_with("pieces")) &&
         (name.ends_with(".csv") || name.ends_with(".csv.partial"));
}

std::vector<fs::path> rows_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing)) {
    if (is_rows_file(entry.path()) && entry.is_regular_file(missing)) files.push_back(entry.path());
  }
  return files;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A row as a line, with its hash at the end.
std::string line_of(const std::string& row) {
  return fmt::format("{}\t{}\n", row, content_hash(row));
}

/// The row of a line, if its hash matches.
std::optional<std::string> row_of(const std::string& line) {
  const std::size_t tab = line.rfind('\t');
  if (tab == std::string::npos || line.substr(tab + 1) != content_hash(std::string_view(line).substr(0, tab)))
    return std::nullopt;
  return line.substr(0, tab);
}

}  // namespace

NumberedRows find_rows(const fs::path& folder, const RowsIdentity& identity, std::size_t* n_damaged) {
  NumberedRows rows;
  if (n_damaged) *n_damaged = 0;
  for (const fs::path& file : rows_files(folder)) {
    const std::string text = text_of(file), start = opening(identity);
    if (!text.starts_with(start)) continue;
    for (std::size_t begin = start.size(), end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
      const std::optional<std::string> row = row_of(text.substr(begin, end - begin));
      std::size_t number = 0;
      if (row && std::istringstream(*row) >> number) {
        rows.emplace(number, *row);
      } else if (n_damaged) {
        ++*n_damaged;
      }
    }
  }
  return rows;
}

void remove_rows(const fs::path& folder) {
  std::error_code ignored;
  for (const fs::path& file : rows_files(folder)) {
    const int handle = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (handle < 0) continue;
    if (flock(handle, LOCK_EX | LOCK_NB) == 0) fs::remove(file, ignored);
    close(handle);
  }
  fs::remove(folder, ignored);  // fails if other files remain in it
}

RowsUnderWay::RowsUnderWay(const fs::path& folder, const std::string& name, RowsIdentity identity)
    : file_(folder / name), partial_(folder / (name + ".partial")), identity_(std::move(identity)) {
  std::error_code failed;
  for (int attempt = 0; handle_ < 0 && attempt < 3; ++attempt) {  // another process may remove the empty folder in between
    fs::create_directories(folder, failed);
    if (failed) throw InputError(fmt::format("cannot create '{}': {}", folder.string(), failed.message()));
    handle_ = open(partial_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  }
  if (handle_ < 0) throw cannot("write", partial_, errno);
  if (flock(handle_, LOCK_EX | LOCK_NB) != 0) {
    close(handle_);
    throw InputError(
        fmt::format("'{}': another process is working on these rows; wait for it, or stop it", partial_.string()));
  }
  const std::string text = text_of(partial_), start = opening(identity_);
  const bool is_ours = text.starts_with(start);
  dropped_stale_ = !is_ours && !start.starts_with(text);        // an incomplete start is not stale
  const std::size_t keep = is_ours ? text.rfind('\n') + 1 : 0;  // drops an incomplete line
  if (ftruncate(handle_, static_cast<off_t>(keep)) != 0) {
    close(handle_);
    throw cannot("write", partial_, errno);
  }
  if (keep == 0) write_line(start);
}

RowsUnderWay::~RowsUnderWay() {
  close(handle_);  // unlocks
}

void RowsUnderWay::append(const std::string& row) {
  write_line(line_of(row));
}

void RowsUnderWay::write_line(const std::string& line) {
  if (write(handle_, line.data(), line.size()) != static_cast<ssize_t>(line.size())) throw cannot("write", partial_, errno);
}

void RowsUnderWay::finish(const NumberedRows& rows) {
  std::string text = opening(identity_);
  for (const auto& [number, row] : rows) text += line_of(row);
  const fs::path whole = file_.string() + ".new";
  write_file(whole, text);
  std::error_code failed;
  fs::rename(whole, file_, failed);
  if (failed) throw InputError(fmt::format("cannot write '{}': {}", file_.string(), failed.message()));
  fs::remove(partial_, failed);
}

}  // namespace driftwright::output
