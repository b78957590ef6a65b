#include "output/rows_under_way.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "base/errors.hpp"
#include "output/results_folder.hpp"

namespace driftwright::output {
namespace {

namespace fs = std::filesystem;

InputError cannot(const std::string& what, const fs::path& path) {
  return InputError(fmt::format("cannot {} '{}': {}", what, path.string(), std::strerror(errno)));
}

std::string opening(const RowsIdentity& identity) {
  return fmt::format("# rows of {}\n{}\n", identity.content, identity.header);
}

bool is_rows_file(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with("sweep") && (name.ends_with(".csv") || name.ends_with(".csv.partial"));
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

}  // namespace

NumberedRows find_rows(const fs::path& folder, const RowsIdentity& identity) {
  NumberedRows rows;
  for (const fs::path& file : rows_files(folder)) {
    const std::string text = text_of(file), start = opening(identity);
    if (!text.starts_with(start)) continue;
    for (std::size_t begin = start.size(), end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
      const std::string row = text.substr(begin, end - begin);
      std::size_t number = 0;
      if (std::istringstream(row) >> number) rows.emplace(number, row);
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
  fs::remove(folder, ignored);  // fails where something is left in it
}

RowsUnderWay::RowsUnderWay(const fs::path& folder, const std::string& name, RowsIdentity identity)
    : file_(folder / name), partial_(folder / (name + ".partial")), identity_(std::move(identity)) {
  std::error_code failed;
  for (int attempt = 0; handle_ < 0 && attempt < 3; ++attempt) {  // another process may take the empty folder away between
    fs::create_directories(folder, failed);
    if (failed) throw InputError(fmt::format("cannot create '{}': {}", folder.string(), failed.message()));
    handle_ = open(partial_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  }
  if (handle_ < 0) throw cannot("write", partial_);
  if (flock(handle_, LOCK_EX | LOCK_NB) != 0) {
    close(handle_);
    throw InputError(
        fmt::format("'{}': another process is working on these rows; wait for it, or stop it", partial_.string()));
  }
  const std::string text = text_of(partial_), start = opening(identity_);
  const bool is_ours = text.starts_with(start);
  dropped_stale_ = !is_ours && !start.starts_with(text);        // a start cut short is nobody's
  const std::size_t keep = is_ours ? text.rfind('\n') + 1 : 0;  // a line cut short goes
  if (ftruncate(handle_, static_cast<off_t>(keep)) != 0) {
    close(handle_);
    throw cannot("write", partial_);
  }
  if (keep == 0) append(start.substr(0, start.size() - 1));
}

RowsUnderWay::~RowsUnderWay() {
  close(handle_);  // unlocks
}

void RowsUnderWay::append(const std::string& row) {
  const std::string line = row + "\n";
  if (write(handle_, line.data(), line.size()) != static_cast<ssize_t>(line.size())) throw cannot("write", partial_);
}

void RowsUnderWay::finish(const NumberedRows& rows) {
  std::string text = opening(identity_);
  for (const auto& [number, row] : rows) text += row + "\n";
  const fs::path whole = file_.string() + ".new";
  write_file(whole, text);
  std::error_code failed;
  fs::rename(whole, file_, failed);
  if (failed) throw InputError(fmt::format("cannot write '{}': {}", file_.string(), failed.message()));
  fs::remove(partial_, failed);
}

}  // namespace driftwright::output
